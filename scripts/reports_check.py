#!/usr/bin/env python3
"""The reports in a browser: pages and a browser enter; facts that hold, or all that do not, leave.

    reports_check.py CHROMIUM FOLDER      FOLDER has NAME/index.html; pictures and PDF files go there too

Each page is looked at on a large and on a narrow screen, light and dark, and printed.
"""

import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

CHROMIUM, FOLDER = sys.argv[1], Path(sys.argv[2]).resolve()
SCREENS = [(1400, "light"), (1400, "dark"), (420, "light"), (420, "dark")]
PAPER_PIXELS = 673  # A4 without the margins of the page's style
MOST_BYTES = 3_000_000

# What is clipped, cut off or covered, as the page itself measures it.
MEASURE = """() => {
  const found = [];
  const say = (what, element) => found.push(`${what}: <${element.tagName.toLowerCase()} class="${element.getAttribute('class') || ''}"> ` +
    `"${element.textContent.trim().slice(0, 50)}"`);
  const root = document.documentElement;
  if (root.scrollWidth > root.clientWidth) found.push(`the page is ${root.scrollWidth} px wide, of ${root.clientWidth}`);
  const shown = (element) => element.getClientRects().length > 0 && getComputedStyle(element).visibility !== 'hidden';
  for (const element of document.querySelectorAll('main *, footer')) {
    if (!shown(element) || element.closest('svg')) continue;
    if (element.clientWidth > 0 && element.scrollWidth > element.clientWidth + 1 && getComputedStyle(element).display !== 'inline')
      say(`${element.scrollWidth} px in ${element.clientWidth}`, element);
  }
  const box = (node) => { const range = document.createRange(); range.selectNodeContents(node); return range.getBoundingClientRect(); };
  for (const cell of document.querySelectorAll('th, td, dd, dt')) {
    if (!shown(cell)) continue;
    if (!cell.textContent.trim()) continue;
    const [text, room] = [box(cell), cell.getBoundingClientRect()];
    if (text.right > room.right + 1 || text.left < room.left - 1) say('text outside its cell', cell);
    if (text.right > root.clientWidth + 1) say('text outside the page', cell);
  }
  for (const head of document.querySelectorAll('thead th')) {
    const text = head.firstChild;
    if (!shown(head) || !text) continue;
    for (const word of text.data.matchAll(/[^\s-]+/g)) {
      const range = document.createRange();
      range.setStart(text, word.index);
      range.setEnd(text, word.index + word[0].length);
      if (new Set([...range.getClientRects()].map((box) => Math.round(box.top))).size > 1) say(`"${word[0]}" is broken`, head);
    }
  }
  for (const svg of document.querySelectorAll('svg')) {
    if (!shown(svg)) continue;
    const room = svg.getBoundingClientRect();
    const texts = [...svg.querySelectorAll('text')].filter(shown).map((text) => [text, text.getBoundingClientRect()]);
    texts.forEach(([text, at], i) => {
      if (at.left < room.left - 1 || at.right > room.right + 1 || at.top < room.top - 2 || at.bottom > room.bottom + 2)
        say('text outside its figure', text);
      for (const [other, there] of texts.slice(i + 1)) {
        const across = Math.min(at.right, there.right) - Math.max(at.left, there.left);
        const down = Math.min(at.bottom, there.bottom) - Math.max(at.top, there.top);
        if (across > 2 && down > 4) found.push(`text on text: "${text.textContent}" and "${other.textContent}" in ${svg.id}`);
      }
    });
  }
  return [...new Set(found)];
}"""

# The least contrast of a text with what is behind it, as WCAG computes it.
CONTRAST = """() => {
  const light = ([r, g, b]) => [r, g, b].map((v) => v / 255).map((v) => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4)
    .reduce((sum, v, i) => sum + v * [0.2126, 0.7152, 0.0722][i], 0);
  const colour = (text) => text.match(/[\\d.]+/g).slice(0, 3).map(Number);
  const paper = light(colour(getComputedStyle(document.body).backgroundColor));
  const inks = [...document.querySelectorAll('p, td, th, svg text')].filter((element) => element.getClientRects().length)
    .map((element) => getComputedStyle(element)[element.closest('svg') ? 'fill' : 'color']);
  return Math.min(...[...new Set(inks)].map((ink) => light(colour(ink)))
    .map((ink) => (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05)));
}"""

faults = []


def fact(name, what, holds):
    if not holds:
        faults.append(f"{name}: {what}")
        print(f"FAILS: {name}: {what}", flush=True)


def opened(browser, file, faults_said, **shape):
    context = browser.new_context(**shape)
    page = context.new_page()
    page.on("console", lambda said: faults_said.append(said.text) if said.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: faults_said.append(str(error)))
    page.on("request", lambda asked: faults_said.append(asked.url) if asked.url != file.as_uri() else None)
    page.goto(file.as_uri())
    return page


def plots_work(page, name):
    """A value under the pointer, zoom by selecting, and back."""
    plot = page.locator("svg:visible:has(g.plot[data-y] path.line)").first
    if plot.count() == 0:
        return
    plot.scroll_into_view_if_needed()
    box = plot.locator("g.ticks-x").bounding_box()
    at = lambda share: (box["x"] + share * box["width"], box["y"] + 0.4 * box["height"])
    ticks = lambda: plot.locator("g.ticks-x text").all_text_contents()
    whole = ticks()
    told = ""
    for share in (0.5, 0.3, 0.7, 0.2, 0.8):
        page.mouse.move(*at(share))
        told = page.locator("#readout").text_content() if page.locator("#readout").is_visible() else told
    fact(name, "values under the pointer", any(letter.isdigit() for letter in told))
    page.mouse.move(*at(0.3))
    page.mouse.down()
    page.mouse.move(*at(0.5), steps=4)
    page.mouse.up()
    fact(name, "zoom by selecting changes the ticks", ticks() != whole and len(ticks()) > 1)
    page.mouse.move(2, 2)
    page.screenshot(path=FOLDER / f"{name}-zoomed.png")
    page.keyboard.press("Escape")
    fact(name, "Escape shows the whole again", ticks() == whole)


def map_plays(page, name):
    if page.locator("svg.map:visible").count() == 0:
        return
    ego = page.locator("svg.map:visible .ego")
    before = ego.get_attribute("cx")
    page.locator(".player button:visible").first.click()
    page.wait_for_timeout(500)
    fact(name, "the ego moves on the map", ego.get_attribute("cx") != before)


def look_at(browser, file):
    name = file.parent.name
    fact(name, f"{file.stat().st_size} bytes, of at most {MOST_BYTES}", file.stat().st_size <= MOST_BYTES)
    said = []
    for width, scheme in SCREENS:
        page = opened(browser, file, said, viewport={"width": width, "height": 900}, color_scheme=scheme)
        for found in page.evaluate(MEASURE):
            fact(name, f"{width} px {scheme}: {found}", False)
        contrast = page.evaluate(CONTRAST)
        fact(name, f"{width} px {scheme}: contrast {contrast:.2f}, of at least 3", contrast >= 3)
        page.screenshot(path=FOLDER / f"{name}-{width}-{scheme}.png", full_page=True)
        if (width, scheme) == (1400, "light"):
            used = page.evaluate("""() => {
              const boxes = [...document.querySelectorAll('main *')].map((e) => e.getBoundingClientRect()).filter((box) => box.width > 0);
              return Math.max(...boxes.map((box) => box.right)) - Math.min(...boxes.map((box) => box.left));
            }""")
            fact(name, f"{used:.0f} px of {width} are used, of at least 80 %", used >= 0.8 * width)
            plots_work(page, name)
            map_plays(page, name)
        page.context.close()
    page = opened(browser, file, said, viewport={"width": PAPER_PIXELS, "height": 900}, color_scheme="dark")
    page.emulate_media(media="print")
    for found in page.evaluate(MEASURE):
        fact(name, f"printed: {found}", False)
    page.screenshot(path=FOLDER / f"{name}-printed.png", full_page=True)
    page.pdf(path=FOLDER / f"{name}.pdf", format="A4", print_background=True, prefer_css_page_size=True)
    page.context.close()
    page = opened(browser, file, said, viewport={"width": 1400, "height": 900}, java_script_enabled=False)
    fact(name, "without a script there are figures and tables", page.locator("svg:visible, table:visible").count() > 0)
    page.context.close()
    fact(name, f"the console says {said}", not said)
    print(f"looked at {name}", flush=True)


def main():
    pages = sorted(FOLDER.glob("*/index.html"))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        for file in pages:
            look_at(browser, file)
        browser.close()
    print(f"{len(pages)} reports looked at, {len(faults)} faults")
    sys.exit(1 if faults or not pages else 0)


main()
