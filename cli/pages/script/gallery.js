// The gallery of two folders: what is shown of it, and a picture large, the test over the reference.

class Gallery {
  constructor(root) {
    this.rows = [...root.querySelectorAll(".pair")];
    this.state = "";
    this.buttons = [...document.querySelectorAll("#filters button")];
    for (const button of this.buttons) button.addEventListener("click", () => { this.state = button.dataset.state; this.filter(); });
    this.part = document.getElementById("part");
    this.part.addEventListener("input", () => this.filter());
    for (const image of root.querySelectorAll("img")) {
      image.tabIndex = 0;
      image.setAttribute("role", "button");
      image.addEventListener("click", () => this.open(image.closest(".pair"), image.alt));
      image.addEventListener("keydown", event => { if (event.key === "Enter") this.open(image.closest(".pair"), image.alt); });
    }
    this.build();
    this.filter();
  }

  filter() {
    const part = this.part.value.toLowerCase();
    for (const row of this.rows)
      row.hidden = (this.state && row.dataset.state !== this.state) || !row.dataset.name.toLowerCase().includes(part);
    for (const button of this.buttons) button.setAttribute("aria-pressed", String(button.dataset.state === this.state));
    document.getElementById("shown").textContent = `${this.visible().length} of ${this.rows.length}`;
  }
  visible() { return this.rows.filter(row => !row.hidden); }

  build() {
    const button = (text, title, action) => element("button", {type: "button", title, onclick: action}, text);
    this.title = element("h2", {});
    this.under = element("img", {alt: "Reference"});
    this.over = element("img", {alt: "Test"});
    this.range = element("input", {type: "range", min: 0, max: 100, value: 50, "aria-label": "Where the test begins", oninput: () => this.split()});
    this.modes = element("div", {className: "segments", role: "group", "aria-label": "What is shown"});
    this.line = element("i", {"aria-hidden": "true"});
    this.names = ["Reference", "Test"].map(name => element("span", {}, name));
    this.stack = element("div", {className: "stack"}, this.under, this.over, this.line, ...this.names);
    this.large = element("div", {className: "large"}, this.stack, this.range);
    this.looker = element("dialog", {className: "looker"}, element("div", {className: "bar"}, this.title, element("span", {className: "gap"}), this.modes,
      button("\u2190", "The picture before (p)", () => this.step(-1)), button("\u2192", "The next picture (n)", () => this.step(1)),
      button("Close", "Close (Esc)", () => this.looker.close())), this.large);
    document.addEventListener("keydown", event => { if (this.looker.open) this.key(event); });  // also where nothing has the focus
    document.querySelector("main").append(this.looker);
  }

  open(row, side) {
    this.row = row;
    const source = name => row.querySelector(`figure[data-side=${name}] img`);
    this.sources = {Reference: source("Reference"), Test: source("Test"), Difference: source("Difference")};
    const has_both = this.sources.Reference && this.sources.Test;
    this.mode = has_both && side !== "Difference" ? "Slider" : side;
    this.title.textContent = row.dataset.name;
    if (!this.looker.open) this.looker.showModal();
    this.show();
    if (!this.range.hidden) this.range.focus();
  }

  show() {
    const has_both = this.sources.Reference && this.sources.Test;
    const modes = [...(has_both ? ["Slider"] : []), ...Object.keys(this.sources).filter(name => this.sources[name])];
    if (!modes.includes(this.mode)) this.mode = modes[0];
    this.modes.replaceChildren(...modes.map(mode => element("button",
      {type: "button", "aria-pressed": String(mode === this.mode), onclick: () => { this.mode = mode; this.show(); }}, mode)));
    const is_slider = this.mode === "Slider", image = this.sources[is_slider ? "Reference" : this.mode];
    this.under.src = image.src;
    for (const part of [this.over, this.range, this.line, ...this.names]) part.hidden = !is_slider;
    if (is_slider) this.over.src = this.sources.Test.src;
    this.large.style.setProperty("--shape", image.naturalWidth ? image.naturalWidth / image.naturalHeight : 1);
    this.split();
  }
  split() {
    this.over.style.clipPath = `inset(0 0 0 ${this.range.value}%)`;
    this.line.style.left = `${this.range.value}%`;
  }

  /// To another row that has pictures.
  step(by) {
    const rows = this.visible().filter(row => row.querySelector("img"));
    const at = rows.indexOf(this.row) + by;
    if (at >= 0 && at < rows.length) this.open(rows[at], this.mode === "Slider" ? "Test" : this.mode);
  }
  key(event) {
    const modes = {s: "Slider", r: "Reference", t: "Test", d: "Difference"};
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Escape") this.looker.close();
    else if (event.key === "n") this.step(1);
    else if (event.key === "p") this.step(-1);
    else if (modes[event.key]) { this.mode = modes[event.key]; this.show(); }
    else if ((event.key === "ArrowLeft" || event.key === "ArrowRight") && event.target !== this.range) {
      this.range.value = Number(this.range.value) + (event.key === "ArrowLeft" ? -2 : 2);
      this.split();
    }
  }
}
