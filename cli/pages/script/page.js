// The page: its theme, what can be copied, and the viewer, if it has one.

function toggle_theme() {
  const root = document.documentElement, is_dark = getComputedStyle(root).colorScheme.includes("dark");
  root.dataset.theme = is_dark ? "light" : "dark";
  try { localStorage.setItem("trueshade-theme", root.dataset.theme); } catch { /* pages from files may have no storage */ }
}

async function start_page() {
  document.getElementById("theme")?.addEventListener("click", toggle_theme);
  for (const code of document.querySelectorAll(".command > code")) code.after(copy_button(() => code.textContent));
  const gallery = document.getElementById("gallery");
  if (gallery) gallery.gallery = new Gallery(gallery);
  const root = document.getElementById("viewer");
  if (!root) return;
  if (typeof DecompressionStream === "undefined") {
    root.replaceChildren(element("p", {className: "note"}, "This browser is too old to unpack the pictures (it lacks DecompressionStream); the reduced ones follow."));
    document.documentElement.classList.remove("has-script");
    return;
  }
  const manifest = JSON.parse(read_table("viewer-manifest"));
  const explanations = await inflated(bytes_of_base64(read_table("viewer-explanations")));
  manifest.points = JSON.parse(new TextDecoder().decode(explanations));
  root.viewer = new Viewer(root, manifest);
}
start_page();
