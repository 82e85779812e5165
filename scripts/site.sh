#!/bin/bash
# scripts/site.sh, which is ./check site: the guides as a static site with a search, in build/site, whose front page is
# README.md. Sphinx reads the pages as they stand (scripts/site/conf.py), and it is an error whatever it warns of, as of a
# link that leads nowhere. Then every link of the made pages is followed, and the site is opened from its folder, without a
# server, in a headless Chromium: searched, in the dark, and as wide as a phone.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
install_packages picture chromium chromium-driver furo python3 python3-myst-parser

# mend_theme STATIC: the theme of Debian 12 takes a script as a module and a style from /javascript, which pages in a folder
# cannot, and its style is dark by the button alone and not where the screen is.
mend_theme() {
  local script=$1/scripts/furo.js style=$1/styles/furo.css
  if grep -q '^import ' "$script"; then
    { cat "$1/scripts/gumshoe-patched.js" && sed '/^import /d' "$script"; } >"$script.new"
    mv "$script.new" "$script"
  fi
  if grep -q 'url(/javascript/' "$style"; then
    sed -i 's|url(/javascript/normalize.css/|url(|' "$style"
    cp /usr/share/javascript/normalize.css/normalize.css "$1/styles/"
  fi
  if ! grep -q prefers-color-scheme "$style"; then
    { echo '@media (prefers-color-scheme: dark) {'
      sed -n '/^ *body\[data-theme="dark"\] {/,/}/p' "$style" | sed 's/="dark"/="auto"/'
      echo '}'; } >>"$style"
  fi
}

out=build/site
rm -rf "$out"
quietly "sphinx-build" sphinx-build -q -n -W --keep-going -c scripts/site -d "$out/.trees" . "$out"
rm -rf "$out/.trees"
cp "$out/README.html" "$out/index.html"
mend_theme "$out/_static"
/usr/bin/python3 scripts/site/follow_links.py "$out"
/usr/bin/python3 tests/pages/test_site.py "$out" "$@"
say "the site of $(find "$out" -name '*.html' | wc -l) pages is in $out: open $out/index.html, or copy the folder to a server"
