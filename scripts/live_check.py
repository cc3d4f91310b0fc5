#!/usr/bin/env python3
"""The page of `live` in a browser: a program and a browser enter; facts that hold, or the first that does not, leave.

    live_check.py HOLDOVER_SIM CHROMIUM FOLDER      pictures go to FOLDER
"""

import re
import time

from live_browser import FOLDER, FRAMES_A_SECOND, Page, chromium, holds, live


def vehicles_move(page):
    before = page.read("state.scene.vehicles.map((one) => one.position_m)")
    frames, _ = page.frames_a_second(2)
    after = page.read("state.scene.vehicles.map((one) => one.position_m)")
    holds("every vehicle moves", all(later - sooner > 5 for sooner, later in zip(before, after)))
    holds(f"the display is smooth: {frames:.0f} frames a second, of at least {FRAMES_A_SECOND}", frames >= FRAMES_A_SECOND)


def silence_and_a_driver(page):
    """By messages alone: the range sensors are covered, and the leader is silent while a person brakes it."""
    page.uncheck("#range_sensor")
    page.keyboard.press("0")
    page.select_option("#of", "0")
    page.locator("#scene").focus()
    holds("the range sensors are off", page.until("state.scene.vehicles.every((one) => !one.sees)"))
    holds("the link has settled", page.until("state.scene.at_s > 9 && state.scene.vehicles[1].target.age_s < 0.2"))
    error, width, _ = page.figures(1)
    speeds = page.seen(0, "speed_mps"), page.seen(1, "speed_mps")
    page.keyboard.press("o")
    page.keyboard.down("ArrowDown")
    holds("a key takes the leader over", page.until("state.scene.vehicles[0].is_driven"))
    holds("the page says so", "You drive vehicle leader" in page.text_content("#driving"))
    holds("the leader brakes", page.until(f"state.scene.vehicles[0].speed_mps < {speeds[0] - 4}"))
    holds("silence: error and bound grow", page.until(
        f"Math.abs(state.scene.vehicles[1].target.error_m) > {error + 1} && "
        f"state.scene.vehicles[1].target.bound_m[1] - state.scene.vehicles[1].target.bound_m[0] > {3 * width}"))
    page.screenshot(path=f"{FOLDER}/silence.png")
    page.keyboard.up("ArrowDown")
    holds("the silence ends: error and bound come back", page.until(
        "state.scene.vehicles[1].target.age_s < 0.2 && Math.abs(state.scene.vehicles[1].target.error_m) < 0.5 && "
        f"state.scene.vehicles[1].target.bound_m[1] - state.scene.vehicles[1].target.bound_m[0] < {3 * width}"))
    holds("the follower has reacted", page.until(f"state.scene.vehicles[1].speed_mps < {speeds[1] - 2}"))
    page.keyboard.press("Enter")
    holds("let go, the unit drives again", page.until(
        "!state.scene.vehicles[0].is_driven && state.scene.vehicles[0].mode === 'cooperative'"))
    holds("and accelerates", page.until("state.scene.vehicles[0].acceleration_mps2 > 0.2"))


def time_goes_back(page):
    page.keyboard.press(" ")
    holds("the space key stops time", page.until("!state.scene.is_playing"))
    ticks, first = page.read("[state.scene.ticks, JSON.stringify(state.scene.vehicles)]")
    page.keyboard.press("b")
    holds("b: ten seconds back", page.until(f"state.scene.ticks === {ticks - 1000}"))
    page.keyboard.press(".")
    holds("the point key: one step", page.until(f"state.scene.ticks === {ticks - 999}"))
    page.order('{"do":"step","ticks":999}')
    holds("and on: the same is seen again", page.until(f"state.scene.ticks === {ticks}")
          and page.read("JSON.stringify(state.scene.vehicles)") == first)


def instruments(page):
    page.click("#frames summary")
    holds("frames are listed", page.until("document.querySelectorAll('#rows tr').length > 10"))
    rows = page.text_content("#rows")
    holds("frames are decoded", "EgoMotionA" in rows and re.search(r"Speed [0-9.]+ m/s", rows) is not None)
    page.check("#rides")
    time.sleep(0.5)
    holds("the driver's view is there", page.is_visible("#view") and page.is_checked("#rides"))


# Scenes reach the page so much later than the answers to its orders, as on a machine that is busy.
LATE = """
globalThis.EventSource = class extends EventSource {
  set onmessage(take) { super.onmessage = (message) => setTimeout(() => take(message), 700); }
};
"""


def the_tour(page):
    page.order('{"do":"pace","factor":4}')
    for step, seconds in enumerate([2, 8, 6, 6, 16], start=1):
        page.click("#tour-next")
        holds(f"step {step} of the tour", page.until(f"document.getElementById('tour-text').textContent.startsWith('{step}. ')"))
        if step == 1:
            page.until("state.scene.at_s < 1.5")
        page.show_on(seconds)
        if step == 1:
            holds("the sliders say what the step has set", page.until("document.getElementById('delay-said').textContent === '0 ms'"))
        if step == 5: # to be seen by others, and past the first second, which does not count
            page.keyboard.press("ArrowDown", delay=1500)
            holds("a key drives the leader in it", page.until("state.scene.vehicles[0].is_driven"))
        if step == 4:
            page.show_on(0.5)
            page.screenshot(path=f"{FOLDER}/without.png")
    page.click("#tour-next")
    page.wait_for_selector("#tour-figures:not([hidden])")
    rows = page.eval_on_selector_all("#tour-figures tbody tr", "(rows) => rows.map((row) => [...row.cells].map((cell) => cell.textContent))")
    print("\n".join("  " + "  ".join(row) for row in rows))
    figures = {name: (ours, theirs) for name, ours, _, theirs in rows}
    holds("each step has figures of its own", all(ours != "–" for ours, _ in figures.values()) and float(figures["perfect link"][0]) < 0.05)
    holds("its figures stand beside the paper's", all(figures[name][1] == "0.50" for name in ("4 s of silence", "you drive"))
          and float(figures["4 s of silence"][0]) < 0.5 and float(figures["without the estimate"][0]) > 5 and figures["you drive"][0] != "–")
    page.order('{"do":"pace","factor":1}')


def main():
    with chromium() as browser, live() as address:
        page = Page(browser, address, viewport={"width": 1280, "height": 900})
        vehicles_move(page)
        silence_and_a_driver(page)
        time_goes_back(page)
        instruments(page)
        page.screenshot(path=f"{FOLDER}/page.png", full_page=True)
        page.uncheck("#rides")
        page.keyboard.press(" ")
        the_tour(page)
        holds(f"no error in the console {page.faults}", page.faults == [])
        page.close()
        page = Page(browser, address, LATE)
        the_tour(page)
        holds(f"nor where scenes are late {page.faults}", page.faults == [])


main()
