// What every page can do: sort its tables, switch between light and dark, copy its command.
"use strict";
(() => {
  for (const table of document.querySelectorAll("table.sortable")) {
    const headers = [...table.tHead.rows[0].cells];
    headers.forEach((header, column) => header.querySelector(".sort")?.addEventListener("click", () => {
      const ascending = header.getAttribute("aria-sort") !== "ascending";
      headers.forEach((other) => other.removeAttribute("aria-sort"));
      header.setAttribute("aria-sort", ascending ? "ascending" : "descending");
      const value = (row) => { const cell = row.cells[column]; return !cell || cell.dataset.value === "" ? null : cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value); };
      const rows = [...table.tBodies[0].rows].sort((one, other) => {
        const a = value(one), b = value(other);
        if (a === null || b === null) return (a === null) - (b === null);
        return (ascending ? 1 : -1) * (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b)));
      });
      table.tBodies[0].append(...rows);
    }));
  }

  document.querySelector(".theme").addEventListener("click", () => {
    const dark = document.documentElement.dataset.theme ? document.documentElement.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset.theme = dark ? "light" : "dark";
  });
  document.querySelector(".copy").addEventListener("click", (event) => {
    navigator.clipboard?.writeText(document.querySelector(".command code").textContent);
    event.target.textContent = "copied";
  });
})();
