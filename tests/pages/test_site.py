"""Opens the site of ./check site from its folder in a headless Chromium: its front page, a search, the dark, a phone.

Usage: test_site.py SITE [PICTURES], a folder in which screenshots are left
"""

import sys
from pathlib import Path

from browser import Browser

WIDE, PHONE = (1400, 1000), (390, 844)
WORDS = "legal set"
LONG_PAGE = "docs/validation.html"


def check(condition, what):
    if not condition:
        raise AssertionError(what)


def check_front(browser, site, shot):
    browser.open(site / "index.html")
    check(browser.run("return document.querySelector('h1').textContent").startswith("Trueshade"), "the front page is README")
    check(browser.run("return [...document.images].every(i => i.naturalWidth > 0)"), "a picture of the front page is missing")
    listed = browser.run("return document.querySelectorAll('.sidebar-tree a').length")
    check(listed > 30, f"{listed} pages are listed beside the front page")
    asked = [address for address in browser.requests() if not address.startswith(("file:", "data:", "chrome"))]
    check(not asked, f"the front page asks the network: {asked}")
    check(not browser.complaints(), "the front page makes the browser complain")
    wide = browser.run("return document.documentElement.scrollWidth")
    check(wide <= WIDE[0], f"the front page is {wide} pixels wide in a window of {WIDE[0]}")
    shot("front")


def check_search(browser, site, shot):
    browser.run("document.querySelector('input.sidebar-search').focus()")
    for letter in WORDS:
        browser.key(letter)
    browser.key("Enter", text="\r")
    result = f"document.querySelector('#search-results li a[href*=\"{LONG_PAGE}\"]')"
    browser.wait(result)
    shot("search")
    browser.run(f"{result}.click()")
    browser.wait(f"location.pathname.endsWith('{LONG_PAGE}') && document.readyState == 'complete'")
    check(browser.run("return document.querySelectorAll('.highlighted').length") > 0, "the words found are not marked")
    shot("guide")
    browser.complaints()  # a result's text is fetched, which files may not


def check_dark(browser, site, shot):
    light = browser.run("return getComputedStyle(document.body).backgroundColor")
    browser.run("document.querySelector('.theme-toggle').click()")
    pressed = browser.run("return getComputedStyle(document.body).backgroundColor")
    browser.run("localStorage.clear()")
    browser.theme("dark")
    browser.open(site / LONG_PAGE)
    dark = browser.run("return getComputedStyle(document.body).backgroundColor")
    brightness = [sum(int(part) for part in color[4:-1].split(",")[:3]) for color in (light, dark)]
    check(brightness[0] > 600 and brightness[1] < 200, f"pages are {light} in the light and {dark} in the dark")
    check(pressed == dark, f"the button for the dark makes pages {pressed}, and not {dark}")
    shot("dark")
    browser.theme("light")


def check_phone(browser, site, shot):
    browser.resize(*PHONE, mobile=True, ratio=2)
    for page in ("index.html", LONG_PAGE, "docs/glossary.html"):
        browser.open(site / page)
        wide = browser.run("return document.documentElement.scrollWidth")
        check(wide <= PHONE[0], f"{page} is {wide} pixels wide on a phone of {PHONE[0]}")
        shot("phone_" + Path(page).stem)


def main():
    site = Path(sys.argv[1]).resolve()
    pictures = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    if pictures:
        pictures.mkdir(parents=True, exist_ok=True)
    with Browser(*WIDE) as browser:
        for part in (check_front, check_search, check_dark, check_phone):
            part(browser, site, lambda name: pictures and browser.screenshot(pictures / f"{name}.png"))
    print(f"the site opens, is searched, is dark where the screen is, and fits a phone ({WORDS!r} in Chromium {browser.version})")
    return 0


if __name__ == "__main__":
    sys.exit(main())
