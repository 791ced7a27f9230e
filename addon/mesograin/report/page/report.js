// The report's viewer: it shows the real, linear pictures that the page carries.
"use strict";
(() => {
  const tables = JSON.parse(document.getElementById("colour-tables").textContent);
  const EPSILON = 0.01;

  // Half floats, all 65536 of them, once.
  const halves = new Float32Array(65536);
  for (let bits = 0; bits < 65536; ++bits) {
    const exponent = (bits >> 10) & 31, fraction = bits & 1023, sign = bits & 32768 ? -1 : 1;
    halves[bits] = exponent === 31 ? (fraction ? NaN : sign * Infinity)
      : sign * (exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : 2 ** -14 * (fraction / 1024));
  }

  // sRGB octets of linear values in [0, 1].
  const encoded = new Uint8Array(8193);
  for (let i = 0; i <= 8192; ++i) {
    const linear = i / 8192;
    encoded[i] = Math.round(255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * linear ** (1 / 2.4) - 0.055));
  }

  async function unpack(name, count) {
    const packed = Uint8Array.from(atob(document.getElementById(name).textContent), (character) => character.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
    const octets = new Uint8Array(await new Response(stream).arrayBuffer());
    const values = new Float32Array(count);
    for (let i = 0; i < count; ++i) values[i] = halves[(octets[i] << 8) | octets[count + i]];
    return values; // channel by channel
  }

  function expose(pixels, count, stops) {
    const image = new Uint8ClampedArray(4 * count), gain = 8192 * 2 ** stops;
    for (let i = 0; i < count; ++i) {
      for (let c = 0; c < 3; ++c) {
        const at = pixels[c * count + i] * gain;
        image[4 * i + c] = encoded[at > 0 ? Math.min(8192, Math.round(at)) : 0];
      }
      image[4 * i + 3] = 255;
    }
    return image;
  }

  // The channels' mean of the relative error, of its size and with its sign.
  function relativeError(model, reference, count) {
    const size = new Float32Array(count), signed = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      for (let c = 0; c < 3; ++c) {
        const r = reference[c * count + i], error = (model[c * count + i] - r) / (Math.max(r, 0) + EPSILON);
        size[i] += Math.abs(error) / 3;
        signed[i] += error / 3;
      }
    }
    return { size, signed };
  }

  function colour(relative, mask, count, table, place) {
    const image = new Uint8ClampedArray(4 * count);
    for (let i = 0; i < count; ++i) {
      if (mask[i] > 0) {
        const at = place(relative[i]), finite = Number.isFinite(at);
        const from = finite ? 3 * Math.max(0, Math.min(255, Math.round(255 * at))) : 0, found = finite ? table : tables.notFinite;
        for (let c = 0; c < 3; ++c) image[4 * i + c] = found[from + c];
      }
      image[4 * i + 3] = 255;
    }
    return image;
  }

  const [low, high] = tables.errorRange.map(Math.log10);
  const logarithmic = (value) => (Math.log10(Math.max(value, 1e-30)) - low) / (high - low);
  const signed = (value) => 0.5 + 0.5 * value / tables.signedRange;
  // Strong from the test's threshold up, pale below it; colours.score_colour is the same.
  const significant = (threshold) => (score) => {
    const relative = score / threshold;
    return 0.5 + 0.5 * (Math.abs(relative) >= 1 ? Math.sign(relative) * (0.5 + 0.2 * Math.abs(relative)) : 0.2 * relative);
  };
  const number = (value) => (value === 0 ? "0" : Math.abs(value) < 0.001 || Math.abs(value) >= 1e4 ? value.toExponential(2) : value.toPrecision(4));

  class Viewer {
    constructor(root, live) {
      Object.assign(this, { root, live, count: live.width * live.height, mode: "split", split: 0.5, flipped: false });
      this.canvas = root.querySelector("canvas");
      this.canvas.width = live.width;
      this.canvas.height = live.height;
      this.stage = root.querySelector(".stage");
      this.divider = root.querySelector(".divider");
      this.context = this.canvas.getContext("2d");
    }

    async start() {
      const { live, count, root } = this;
      [this.model, this.reference, this.mask] = await Promise.all(
        [unpack(live.model, 3 * count), unpack(live.reference, 3 * count), unpack(live.mask, count)]);
      this.scores = live.scores ? await unpack(live.scores, count) : null;
      this.relative = relativeError(this.model, this.reference, count);
      this.shown = {
        error: this.image(colour(this.relative.size, this.mask, count, tables.sequential, logarithmic)),
        signed: this.image(colour(this.relative.signed, this.mask, count, tables.diverging, signed)),
      };
      if (this.scores) this.shown.scores = this.image(colour(this.scores, this.mask, count, tables.diverging, significant(live.threshold)));
      this.setExposure(Number(root.querySelector(".exposure input").value));
      this.root.querySelector(".still").hidden = true;
      this.canvas.hidden = false;
      this.listen();
    }

    image(octets) { return new ImageData(octets, this.live.width, this.live.height); }

    setExposure(stops) {
      this.shown.model = this.image(expose(this.model, this.count, stops));
      this.shown.reference = this.image(expose(this.reference, this.count, stops));
      this.root.querySelector(".exposure output").textContent = (stops >= 0 ? "+" : "−") + Math.abs(stops).toFixed(1);
      this.draw();
    }

    draw() {
      const { width, height } = this.live, { context, shown, mode } = this;
      const isSplit = mode === "split", at = Math.round(this.split * width);
      if (isSplit) {
        context.putImageData(shown.reference, 0, 0);
        if (at > 0) context.putImageData(shown.model, 0, 0, 0, 0, at, height);
      } else {
        context.putImageData(mode === "flip" ? (this.flipped ? shown.reference : shown.model) : shown[mode], 0, 0);
      }
      this.divider.hidden = !isSplit;
      this.divider.style.left = `${100 * this.split}%`;
      const [left, right] = this.root.querySelectorAll(".tag");
      left.hidden = mode !== "split" && mode !== "flip";
      left.textContent = mode === "flip" && this.flipped ? "reference" : "model";
      right.hidden = !isSplit;
      for (const legend of ["error", "signed", "scores"]) {
        const bar = this.root.querySelector(`.${legend}-legend`);
        if (bar) bar.hidden = mode !== legend;
      }
      this.stage.style.cursor = isSplit ? "ew-resize" : "crosshair";
    }

    setMode(mode) {
      this.mode = mode;
      for (const button of this.root.querySelectorAll(".modes button")) button.setAttribute("aria-pressed", button.dataset.mode === mode);
      this.draw();
    }

    place(event) {
      const box = this.canvas.getBoundingClientRect();
      return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    }

    read(event) {
      const [u, v] = this.place(event), { width, height } = this.live;
      const x = Math.min(width - 1, Math.max(0, Math.floor(u * width))), y = Math.min(height - 1, Math.max(0, Math.floor(v * height)));
      const i = y * width + x;
      const rgb = (pixels) => [0, 1, 2].map((c) => number(pixels[c * this.count + i]).padStart(9)).join(" ");
      this.root.querySelector(".readout").textContent =
        `x ${x}, y ${y}\nmodel     ${rgb(this.model)}\nreference ${rgb(this.reference)}\nerror     ${(100 * this.relative.signed[i]).toFixed(2).padStart(9)} %${this.mask[i] > 0 ? this.scores ? `  ${this.scores[i].toFixed(1)} σ` : "" : "  not compared"}`;
    }

    listen() {
      const { stage, root } = this;
      let dragging = false;
      const move = (event) => {
        if (this.mode === "split" && (dragging || event.pointerType === "mouse" && event.buttons === 1)) {
          this.split = Math.min(1, Math.max(0, this.place(event)[0]));
          this.draw();
        }
        this.read(event);
      };
      stage.addEventListener("pointerdown", (event) => { dragging = true; stage.setPointerCapture(event.pointerId); this.split = this.mode === "split" ? Math.min(1, Math.max(0, this.place(event)[0])) : this.split; this.draw(); });
      stage.addEventListener("pointerup", () => { dragging = false; });
      stage.addEventListener("pointermove", move);
      stage.addEventListener("pointerenter", () => { this.flipped = true; if (this.mode === "flip") this.draw(); });
      stage.addEventListener("pointerleave", () => { this.flipped = false; if (this.mode === "flip") this.draw(); });
      stage.addEventListener("keydown", (event) => {
        const step = { ArrowLeft: -0.02, ArrowRight: 0.02, Home: -1, End: 1 }[event.key];
        if (step && this.mode === "split") { this.split = Math.min(1, Math.max(0, this.split + step)); this.draw(); event.preventDefault(); }
        if (event.key === " " && this.mode === "flip") { this.flipped = !this.flipped; this.draw(); event.preventDefault(); }
      });
      for (const button of root.querySelectorAll(".modes button")) button.addEventListener("click", () => this.setMode(button.dataset.mode));
      const exposure = root.querySelector(".exposure input");
      exposure.addEventListener("input", () => this.choose(Number(exposure.value)));
      exposure.addEventListener("dblclick", () => { exposure.value = this.live.stops; this.choose(this.live.stops); });
    }

    // The exposure of this case, or of all of them.
    choose(stops) {
      if (!this.root.querySelector(".linked").checked) return this.setExposure(stops);
      for (const slider of document.querySelectorAll(".exposure input[type=range]")) slider.value = stops;
      for (const viewer of viewers) viewer.setExposure(stops);
    }
  }

  const viewers = [];
  for (const box of document.querySelectorAll(".linked")) {
    box.addEventListener("change", () => {
      for (const other of document.querySelectorAll(".linked")) other.checked = box.checked;
    });
  }

  // Pictures are unpacked when they come near: a page may hold many.
  const waiting = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (!entry.isIntersecting) continue;
      waiting.unobserve(entry.target);
      const viewer = new Viewer(entry.target, JSON.parse(entry.target.querySelector(".live").textContent));
      viewer.start().then(() => viewers.push(viewer), () => entry.target.querySelector(".tools").remove());
    }
  }, { rootMargin: "1200px" });
  for (const root of document.querySelectorAll(".viewer")) {
    if (root.querySelector(".live") && "DecompressionStream" in window) waiting.observe(root);
    else root.querySelector(".tools").remove();
  }
})();
