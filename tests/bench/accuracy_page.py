"""The accuracy table for readers: means over cases, the thesis beside them, and what was asked for and met."""
import pathlib

import jinja2
import numpy

HERE = pathlib.Path(__file__).resolve().parent
# The rows that the thesis' models were measured at before: material, radius; eta 1.3.
KNOWN = (("0.9/0.1", 0.6), ("0.9/0.1", 2.4), ("0.9/0.1", 7.2), ("0.9/0.1", 14.4), ("0.9/0.1", 48.0), ("0.5/0.5", 2.4),
         ("0.5/0.5", 14.4), ("0.1/0.9", 14.4), ("1/0.001", 2.4), ("1/0.001", 14.4))
# sigma_s/sigma_t of at least 1/2 in every channel.
BRIGHT = ("0.9/0.1", "0.5/0.5", "0.8/0.2", "1/0.001", "apple", "marble", "skin1", "wholemilk")
DARK_RADII = (0.6, 2.4, 7.2)


def name_of(model, taps):
    return model + (f" N={taps}" if taps else "")


def _variants(rows):
    return sorted({(row["model"], row["taps"]) for row in rows})


def _mean(rows, key="relative_l1"):
    return float(numpy.mean([row[key] for row in rows])) if rows else None


def by_radius(rows):
    """[(name, [mean relative_l1 at each radius, then all], the same of the thesis' form, mean shade_ms)]."""
    radii = sorted({row["radius"] for row in rows})
    lines = []
    for variant in _variants(rows):
        chosen = [row for row in rows if (row["model"], row["taps"]) == variant]
        groups = [[row for row in chosen if row["radius"] == radius] for radius in radii] + [chosen]
        lines.append((name_of(*variant), [_mean(group) for group in groups],
                      [_mean(group, "thesis_relative_l1") for group in groups], _mean(chosen, "shade_ms")))
    return radii, lines


def known(rows):
    """[(material, radius, [(name, row)])] at eta 1.3."""
    table = []
    for material, radius in KNOWN:
        chosen = {(row["model"], row["taps"]): row for row in rows
                  if row["material"] == material and row["radius"] == radius and row["eta"] == 1.3}
        if chosen:
            table.append((material, radius, [(name_of(*variant), chosen[variant]) for variant in sorted(chosen)]))
    return table


def findings(rows):
    """[(what was asked for, whether it was met, the figures)]; only what the rows can tell."""
    last = max((row["taps"] for row in rows if row["model"] == "model_3"), default=None)
    best = {(row["material"], row["eta"], row["radius"]): row for row in rows
            if row["model"] == "model_3" and row["taps"] == last}
    at_1_3 = [row for key, row in best.items() if key[1] == 1.3]
    found = []

    def add(asked, met, figures):
        found.append({"asked": asked, "met": met, "figures": figures})

    thick = [row for row in at_1_3 if row["radius"] >= 14.4 and row["material"] in BRIGHT]
    if thick:
        worst = max(thick, key=lambda row: row["relative_l1"])
        add(f"model 3, N={last}: mean L1 within 12 % for radius 14.4 and more, eta 1.3, albedo 0.5 and more",
            _mean(thick) <= 0.12, f"mean {_mean(thick):.1%}, worst {worst['relative_l1']:.1%} "
            f"({worst['material']}, radius {worst['radius']:g})")
    rivals = [row for row in at_1_3 if (row["material"], row["radius"]) in KNOWN
              and (row["material"], row["radius"]) != ("0.5/0.5", 2.4)]
    if rivals:
        lost = [row for row in rivals if row["relative_l1"] >= row["thesis_relative_l1"]]
        add("model 3 better than the thesis' model 3 in the rows of the table below (0.5/0.5 at 2.4 apart)", not lost,
            _list(lost) if lost else f"in all {len(rivals)}")
    thesis = {}
    for row in rows:
        thesis.setdefault((row["material"], row["eta"], row["radius"]), []).append(row["thesis_relative_l1"])
    large = [row for key, row in best.items() if key[2] >= 7.2]
    if large:
        lost = [row for row in large
                if row["relative_l1"] >= min(thesis[row["material"], row["eta"], row["radius"]])]
        add("model 3 better than all three of the thesis' models for radius 7.2 and more", not lost,
            _list(lost) if lost else f"in all {len(large)} cases")
    ones = {(row["material"], row["eta"], row["radius"]): row for row in rows if row["model"] == "model_1"}
    twos = [row for row in rows if row["model"] == "model_2"]
    if ones and twos:
        lost = [row for row in twos
                if row["relative_l1"] > ones[row["material"], row["eta"], row["radius"]]["relative_l1"]
                + row["noise_floor"]]
        add("model 2 never worse than model 1 (by more than the truth's noise)", not lost,
            _list(lost) if lost else f"in all {len(twos)} cases")
        dark = [row for row in twos if row["radius"] in DARK_RADII]
        lost = [row for row in dark if row["dark_relative_l1"] > 0.5]
        mean = _mean(dark, "dark_relative_l1")
        add("model 2 on the dark side at most half of model 1's error (which is 100 %), radius up to 7.2", not lost,
            f"mean {mean:.1%}; " + (f"not in {len(lost)} of {len(dark)}: {_list(lost, 'dark_relative_l1')}" if lost
                                    else f"in all {len(dark)} cases"))
    means = [(name_of(*variant), _mean([row for row in rows if (row["model"], row["taps"]) == variant]))
             for variant in _variants(rows)]
    add("the error falls with the cost, on average over the table",
        all(a[1] >= b[1] for a, b in zip(means, means[1:])), ", ".join(f"{name} {mean:.1%}" for name, mean in means))
    return found


def _list(rows, key="relative_l1"):
    shown = sorted(rows, key=lambda row: -row[key])[:8]
    text = ", ".join(f"{row['material']} eta {row['eta']:g} radius {row['radius']:g} ({row[key]:.0%})" for row in shown)
    return text + (f" and {len(rows) - len(shown)} more" if len(rows) > len(shown) else "")


def dark(row, prefix=""):
    """The dark side's ratio to the truth, or a dash where too few photons came to tell."""
    told = row["dark_noise"] is not None and row["dark_noise"] < 0.25
    return f"{row[prefix + 'dark_ratio']:.2f}" if told else "–"


def render(template, rows, by_g, device):
    """The text of a page in this folder. by_g: what `anisotropic.by_g` gives."""
    environment = jinja2.Environment(loader=jinja2.FileSystemLoader(HERE), trim_blocks=True, lstrip_blocks=True,
                                     keep_trailing_newline=True, autoescape=template.endswith(".html.j2"),
                                     undefined=jinja2.StrictUndefined)
    environment.filters["percent"] = lambda value: f"{100.0 * value:.1f}"
    environment.filters["dark"] = dark
    radii, lines = by_radius(rows)
    values_of_g, anisotropic = by_g
    return environment.get_template(template).render(
        radii=radii, lines=lines, known=known(rows), rows=rows, findings=findings(rows), device=device,
        values_of_g=values_of_g,
        anisotropic=[(name_of(model, taps), means) for model, taps, means in anisotropic])
