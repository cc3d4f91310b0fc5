#!/usr/bin/env python3
"""The page of `live` by every kind of input, and on every kind of screen: a program and a browser enter; facts that hold, or the first that
does not, leave.

    live_input_check.py HOLDOVER_SIM CHROMIUM FOLDER      pictures go to FOLDER
"""

import time
from pathlib import Path

from live_browser import CHROMIUM, FOLDER, Page, chromium, holds, live

# A gamepad that the check plays on.
PAD = """
globalThis.pad = { connected: true, mapping: "standard", axes: [0, 0], buttons: [...Array(17)].map(() => ({ value: 0, pressed: false })) };
navigator.getGamepads = () => [globalThis.pad];
"""
# Text that is wider or higher than its box, outside of what scrolls.
CLIPPED = """
[...document.querySelectorAll("button, a, label, legend, h1, h2, p, output, summary, figcaption, select")].filter((one) => {
  const box = one.getBoundingClientRect();
  if (!box.width || !box.height || one.closest(".scroll, .unseen")) return false;
  const isCut = getComputedStyle(one).overflow !== "visible" && one.scrollWidth > one.clientWidth + 1;
  return isCut || box.left < -0.5 || box.right > innerWidth + 0.5;
}).map((one) => one.textContent.trim().slice(0, 40))
"""
FOCUSABLE = "button, a[href], input, select, summary, [tabindex='0']"


def a_gamepad_drives(browser, address):
    page = Page(browser, address, PAD)
    page.keyboard.press("0")
    page.evaluate("globalThis.pad.buttons[6].value = 0.5")
    holds("a trigger takes the leader over", page.until("state.scene.vehicles[0].is_driven"))
    holds("it brakes by half", "-4 m/s²" in page.text_content("#driving") or page.until("state.scene.vehicles[0].acceleration_mps2 < -2"))
    speed = page.seen(0, "speed_mps")
    page.evaluate("(globalThis.pad.buttons[6].value = 0, globalThis.pad.buttons[7].value = 1)")
    holds("the other trigger accelerates it", page.until(f"state.scene.vehicles[0].speed_mps > {speed}"))
    page.evaluate("globalThis.pad.buttons[7].value = 0")
    page.evaluate("globalThis.pad.buttons[0].pressed = true")
    holds("its first button lets go", page.until("!state.scene.vehicles[0].is_driven"))
    page.evaluate("globalThis.pad.buttons[0].pressed = false")
    page.evaluate("globalThis.pad.buttons[6].value = 0.08")
    time.sleep(0.4)
    holds("a trigger that does not come back quite takes nothing over", not page.seen(0, "is_driven"))
    page.evaluate("globalThis.pad.buttons[6].value = 0")
    page.evaluate("(globalThis.pad.mapping = '', globalThis.pad.axes[1] = 1)")
    time.sleep(0.4)
    holds("nor do pedals that lie at the end of their axis from the start", not page.seen(0, "is_driven"))
    page.evaluate("globalThis.pad.axes[1] = 0")
    time.sleep(0.2)
    page.evaluate("globalThis.pad.axes[1] = 1")
    holds("pedals on an axis brake", page.until("state.scene.vehicles[0].is_driven && state.scene.vehicles[0].acceleration_mps2 < -2"))
    page.evaluate("globalThis.pad.connected = false")
    holds("pulled out while it brakes, it brakes no more", page.until("state.scene.vehicles[0].command_mps2 === 0"))
    holds("and the page says that none is there", "none is there" in page.text_content("#pad"))
    page.locator("#scene").focus()
    page.keyboard.press("Enter")
    holds("the keys are left", page.until("!state.scene.vehicles[0].is_driven"))
    page.evaluate("(globalThis.pad.connected = true, globalThis.pad.mapping = 'standard', globalThis.pad.axes[1] = 0)")
    page.evaluate("globalThis.pad.buttons[7].value = 1")
    holds("plugged in again it drives again", page.until("state.scene.vehicles[0].is_driven && state.scene.vehicles[0].command_mps2 > 1"))
    page.evaluate("globalThis.pad.buttons[7].value = 0")
    page.keyboard.press("Enter")
    page.keyboard.down("ArrowDown")
    page.until("state.scene.vehicles[0].command_mps2 < -3")
    soft = page.seen(0, "command_mps2")
    page.keyboard.down("Shift")
    holds("Shift while a key brakes brakes harder", page.until(f"state.scene.vehicles[0].command_mps2 < {soft - 2}"))
    page.keyboard.up("Shift")
    page.keyboard.up("ArrowDown")
    page.keyboard.press("Enter")
    page.until("!state.scene.vehicles[0].is_driven")
    return page


class Fingers:
    """Fingers on the screen, as the browser gets them from the system."""

    def __init__(self, page):
        self.link = page.page.context.new_cdp_session(page.page)

    def lie(self, kind, *places):
        points = [{"x": x, "y": y, "id": number} for number, (x, y) in enumerate(places)]
        self.link.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    def stroke(self, *ways, steps=8):
        """Each finger along its way, from its first place to its last."""
        self.lie("touchStart", *[begin for begin, _ in ways])
        for step in range(1, steps + 1):
            self.lie("touchMove", *[tuple(a + (b - a) * step / steps for a, b in zip(*way)) for way in ways])
            time.sleep(0.03)
        self.lie("touchEnd")
        time.sleep(0.2)


def a_phone(browser, name, address):
    """A screen of 390 by 844 that is touched."""
    context = browser.new_context(viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True, device_scale_factor=2)
    page = Page(context, address)
    fingers = Fingers(page)
    box = page.locator("#scene").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    camera = lambda: page.evaluate("({ ...globalThis.holdover.camera })")
    page.uncheck("#follows")
    place = lambda: camera().get("middleM", camera().get("e"))
    before = place()
    fingers.stroke((middle, (middle[0] - 100, middle[1])))
    holds(f"{name}: a finger moves the road", place() > before + 1)
    before = camera()["perM"]
    fingers.stroke(((middle[0] - 30, middle[1]), (middle[0] - 120, middle[1])), ((middle[0] + 30, middle[1]), (middle[0] + 120, middle[1])))
    holds(f"{name}: two fingers zoom", camera()["perM"] > 2.5 * before)
    fingers.stroke(((middle[0] - 120, middle[1]), (middle[0] - 30, middle[1])), ((middle[0] + 120, middle[1]), (middle[0] + 30, middle[1])))
    holds(f"{name}: and back", camera()["perM"] < 1.5 * before)
    page.locator("#plots").scroll_into_view_if_needed()
    plot = page.locator("#plots canvas").first.bounding_box()
    up = page.evaluate("scrollY")
    at = plot["x"] + 100, plot["y"] + 50
    fingers.stroke((at, (at[0], at[1] + 150)))
    holds(f"{name}: a finger on an instrument moves the page", page.evaluate("scrollY") < up - 50)
    holds(f"{name}: nothing is wider than the phone", page.evaluate("document.documentElement.scrollWidth <= window.innerWidth"))
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=f"{FOLDER}/{name}-phone.png")
    return page


def pedals_on_the_screen_drive(browser, address):
    page = a_phone(browser, "string", address)
    page.evaluate("globalThis.holdover.choose(0)")
    page.locator("#brake").scroll_into_view_if_needed()
    box = page.locator("#brake").bounding_box()
    fingers = Fingers(page)
    speed = page.seen(0, "speed_mps")
    fingers.lie("touchStart", (box["x"] + 20, box["y"] + 20))
    holds("a finger on the pedal brakes", page.until(f"state.scene.vehicles[0].is_driven && state.scene.vehicles[0].speed_mps < {speed - 2}"))
    holds("the pedal shows it", page.evaluate("document.getElementById('brake').classList.contains('is-down')"))
    fingers.lie("touchEnd")
    holds("lifted, it rolls", page.until("state.scene.vehicles[0].command_mps2 === 0"))
    page.tap("#release")
    holds("let go, its unit drives", page.until("!state.scene.vehicles[0].is_driven"))
    mouse = Page(browser, address, viewport={"width": 1280, "height": 900})
    mouse.evaluate("globalThis.holdover.choose(0)")
    box = mouse.locator("#gas").bounding_box()
    mouse.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.mouse.down()
    holds("the mouse on the other pedal accelerates", mouse.until("state.scene.vehicles[0].is_driven && state.scene.vehicles[0].acceleration_mps2 > 0.5"))
    mouse.mouse.up()
    mouse.click("#release")
    holds("and lets go", mouse.until("!state.scene.vehicles[0].is_driven"))
    return page, mouse


def every_screen(browser, name, address):
    pages = []
    for scheme in ("light", "dark"):
        for width in (390, 1280):
            page = Page(browser, address, viewport={"width": width, "height": 860}, color_scheme=scheme)
            time.sleep(0.3)
            holds(f"{name}, {width} px, {scheme}: nothing is wider than the screen",
                  page.evaluate("document.documentElement.scrollWidth <= window.innerWidth"))
            clipped = page.evaluate(CLIPPED)
            holds(f"{name}, {width} px, {scheme}: no text is cut off {clipped}", clipped == [])
            dim = page.evaluate("""(() => { const light = (text) => { const [r, g, b] = text.match(/[0-9.]+/g).map(Number).map((c) => c / 255)
                .map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4)); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
                const ground = light(getComputedStyle(document.body).backgroundColor);
                return [...document.querySelectorAll("button:not(:disabled), label, td, p.hint, th")].filter((one) => one.offsetWidth)
                .map((one) => { const ink = light(getComputedStyle(one).color);
                  return (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05); }).reduce((a, b) => Math.min(a, b)); })()""")
            holds(f"{name}, {width} px, {scheme}: contrast of text {dim:.1f}, of at least 4.5", dim >= 4.5)
            page.screenshot(path=f"{FOLDER}/{name}-{width}-{scheme}.png", full_page=width == 390)
            pages.append(page)
    return pages


def the_keyboard_is_enough(browser, address):
    page = Page(browser, address, viewport={"width": 1280, "height": 900})
    page.evaluate(f"globalThis.wanted = new Set([...document.querySelectorAll(\"{FOCUSABLE}\")].filter((one) => !one.disabled && one.offsetWidth))")
    wanted = page.evaluate("globalThis.wanted.size")
    seen_outline = True
    for _ in range(2 * wanted):
        page.keyboard.press("Tab")
        seen_outline &= page.evaluate("(() => { const one = document.activeElement; globalThis.wanted.delete(one); "
                                      "return one === document.body || getComputedStyle(one).outlineStyle !== 'none'; })()")
    left = page.evaluate("[...globalThis.wanted].map((one) => one.id || one.textContent)")
    holds(f"Tab reaches all {wanted} controls {left}", left == [])
    holds("and shows where it is", seen_outline)
    page.focus("#vehicles tr:nth-child(4) button")
    page.keyboard.press("Enter")
    holds("Enter on a vehicle's button chooses it", page.read("state.chosen") == 3)
    page.focus("#newests")
    page.keyboard.press("Space")
    holds("the space key ticks a box", page.is_checked("#newests"))
    page.focus("#delay")
    page.keyboard.press("End")
    holds("and an arrow moves a slider", page.text_content("#delay-said") == "1000 ms")
    page.keyboard.press("Home")
    page.focus("#brake")
    page.keyboard.down("Space")
    holds("and holds a pedal", page.until("state.scene.vehicles[3].is_driven"))
    page.keyboard.up("Space")
    page.focus("#release")
    page.keyboard.press("Enter")
    holds("and lets go", page.until("!state.scene.vehicles[3].is_driven"))
    return page


def a_screen_reader_finds_its_way(page):
    told = page.locator("body").aria_snapshot()
    Path(FOLDER, "aria.txt").write_text(told, encoding="utf-8")
    for role in ('heading "holdover', "status", "table", "columnheader", "rowheader", 'button "Pause"', 'group "time"', 'group "what is shown"',
                 'checkbox "holdover: drive by the estimate"', 'combobox "Of', 'slider "Delay, mean', 'spinbutton "for', 'region "controls"',
                 'link "Scenario with this drive"', "img"):
        holds(f"it finds {role}", role in told)
    nameless = page.evaluate("[...document.querySelectorAll('button, a, input, select, canvas, table')].filter((one) => "
                             "!(one.textContent.trim() || one.ariaLabel || one.labels?.length || one.getAttribute('aria-label'))).length")
    holds("and nothing is without a name", nameless == 0)
    # What the browser tells the system, and with it a screen reader.
    nodes = page.page.context.new_cdp_session(page.page).send("Accessibility.getFullAXTree")["nodes"]
    told = [(node["role"]["value"], node.get("name", {}).get("value", ""), {one["name"]: one["value"].get("value") for one in node.get("properties", [])})
            for node in nodes if not node["ignored"]]
    mute = [role for role, name, properties in told if properties.get("focusable") and role != "RootWebArea" and not name]
    holds(f"all of {sum(bool(properties.get('focusable')) for _, _, properties in told)} places where the focus can be have a name {mute}", mute == [])
    pictures = [name for role, name, _ in told if role in ("image", "img", "Canvas")]
    holds(f"the {len(pictures)} pictures say what they are and where the same stands as text", len(pictures) >= 9 and all(pictures))
    slider = page.evaluate("document.getElementById('delay').ariaValueText")
    holds(f"a slider is told with its unit: {slider}", str(slider).endswith(" ms"))


def it_is_told_little(browser, address):
    """What a screen reader would speak by itself, while vehicles drive and a silence comes and goes."""
    page = Page(browser, address)
    page.evaluate("""globalThis.spoken = []; for (const one of document.querySelectorAll("[aria-live]:not([aria-live=off]), [role=status]:not([aria-live]), output"))
        new MutationObserver(() => globalThis.spoken.push(one.textContent)).observe(one, { childList: true, characterData: true, subtree: true })""")
    page.until("state.scene.vehicles[state.chosen].mode === 'cooperative'")
    time.sleep(3)
    quiet = page.evaluate("globalThis.spoken.splice(0)")
    holds(f"while all stays as it is, little is spoken {quiet}", len(quiet) <= 2)
    page.fill("#seconds", "2.5")
    page.click("#outage")
    time.sleep(6)
    spoken = [text for text in page.evaluate("globalThis.spoken.splice(0)") if text]
    holds(f"a silence and its end are spoken, and nothing else {spoken}", 2 <= len(spoken) <= 5
          and any("is silent" in text for text in spoken) and any("heard again" in text for text in spoken))
    page.locator("#scene").focus()
    page.keyboard.press(" ")
    holds("that time stands still is spoken", page.until("document.getElementById('told').textContent.startsWith('Time stands still at ')"))
    page.keyboard.press(" ")
    return page


def pace(page):
    """How fast the simulation's time goes on, as the page sees it over 3 s: 1 is real time."""
    began, at_s = time.monotonic(), page.read("state.scene.at_s")
    time.sleep(3)
    return (page.read("state.scene.at_s") - at_s) / (time.monotonic() - began)


def a_stalled_browser_holds_nobody_up(browser, address):
    second = browser.browser_type.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
    one, other = Page(second, address), Page(browser, address)
    time.sleep(1)  # both have caught up
    # Of three times, because the machine may be busy with something else in one of them.
    for _ in range(3):
        usual = pace(other)
        one.evaluate("void setTimeout(() => { const end = Date.now() + 4000; while (Date.now() < end); }, 0)")
        stalled = pace(other)
        if usual > 0.5 and stalled > 0.83 * usual:
            break
    holds(f"while one browser is stalled for 4 s, the other one sees time go on at {stalled:.2f} of real time, {usual:.2f} before",
          usual > 0.5 and stalled > 0.83 * usual)
    ticks = other.read("state.scene.ticks")
    holds("the stalled one comes back to the newest scene", one.until(f"state.scene.ticks >= {ticks}"))
    one.order('{"do":"drive","vehicle":0,"mps2":-1}')
    holds("what one does the other one sees", other.until("state.scene.vehicles[0].is_driven"))
    other.order('{"do":"release","vehicle":0}')
    holds("and the other way", one.until("!state.scene.vehicles[0].is_driven"))
    return one, other


def main():
    with chromium() as browser, live() as address:
        pages = [a_gamepad_drives(browser, address)]
        pages.extend(pedals_on_the_screen_drive(browser, address))
        pages.append(the_keyboard_is_enough(browser, address))
        a_screen_reader_finds_its_way(pages[-1])
        pages.append(it_is_told_little(browser, address))
        pages.extend(a_stalled_browser_holds_nobody_up(browser, address))
        pages.extend(every_screen(browser, "string", address))
        with live("corridor") as corridor:
            start = Page(browser, corridor)
            start.order('{"do":"restart"}')
            start.order('{"do":"pause"}')
            holds("nobody drives at the beginning", start.until("!state.scene.is_playing && state.scene.vehicles.length === 0"))
            holds("that time stands still is spoken there too",
                  start.until("document.getElementById('told').textContent.startsWith('Time stands still at ')"))
            start.order('{"do":"play"}')
            start.order('{"do":"step","ticks":4000}')
            holds("vehicles are on the roads", start.until("state.scene.ticks >= 4000", 30))
            pages.append(a_phone(browser, "roads", corridor))
            pages.extend(every_screen(browser, "roads", corridor))
        faults = [fault for page in pages for fault in page.faults if "ERR_CONNECTION" not in fault and "ERR_INCOMPLETE" not in fault]
        holds(f"no error in any console {faults}", faults == [])


main()
