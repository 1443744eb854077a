"""A whole match by one hand: with the keyboard alone, and with fingers alone on a phone."""

import pytest
from contestant import Contestant, Sit
from playwright.sync_api import expect
from show import broken_names, covered, violations
from venue import REFEREE, TOKENS, Venue

from lacoc_shared.seat import Phase

pytestmark = pytest.mark.slow

MOST_SCRIPT_BYTES, MOST_SCRIPTS = 200_000, 12
"""What a player's page loads, packed."""
PACKED = """
performance.getEntriesByType("resource").filter(({ name }) => name.endsWith(".js"))
  .map(({ encodedBodySize }) => encodedBodySize)
"""
PHONE = {"width": 390, "height": 844}
LONG = "Pneumonoultramicroscopic"
"""The longest name of a team, in one word."""
BIG = ".big:not(.fresh) .act:not([aria-disabled=true])"
"""The referee's button for the next decision."""
_MOST_TABS = 80


class Keyboard:
    """A person who has no mouse.

    Args:
        page: the page that she uses.
    """

    def __init__(self, page: Contestant) -> None:
        self._page = page

    def go_to(self, selector: str) -> None:
        """Press Tab until the element has the focus."""
        wanted = self._page.find(selector).first
        expect(wanted).to_be_visible()
        expect(wanted).to_be_enabled()
        for _ in range(_MOST_TABS):
            if wanted.evaluate("element => element === document.activeElement"):
                return
            self._page.press("Tab")
        pytest.fail(f"Tab does not lead to {selector}")

    def use(self, selector: str) -> None:
        """Go to a button, and press it with Enter."""
        self.go_to(selector)
        self._page.press("Enter")

    def write(self, selector: str, text: str) -> None:
        """Go to a field, and type a text."""
        self.go_to(selector)
        self._page.page.keyboard.type(text)


HEARD = """
window.heard = [];
window.OscillatorNode = class extends OscillatorNode {
  constructor(audio, options) {
    super(audio, options);
    window.heard.push(Math.round(options.frequency));
  }
};
"""
"""Notes the tones that a page plays [Hz]."""
COUNT_HZ, START_HZ, END_HZ = 440, 880, 784


def opened(venue: Venue, sit: Sit, **options: object) -> Contestant:
    """Start a court for a match of some seconds, and open the link of the left seat."""
    venue.court("--seconds", "6")
    venue.web()
    page = sit(venue.url, **options)
    page.open(token=TOKENS["left"])
    return page


@pytest.mark.long
def test_a_match_by_keyboard_alone(venue: Venue, sit: Sit) -> None:
    """A contestant and a referee who have no mouse bring a match to its official result."""
    page = opened(venue, sit)
    page.page.add_init_script(HEARD)
    page.page.reload()
    keyboard = Keyboard(page)
    keyboard.write("#join-name", "Ants")
    page.press("Enter")
    page.stands("seated")
    keyboard.use("button.ready")
    venue.contestant("right", "Bees")
    page.phase(Phase.READY)

    judge = sit(venue.url)
    judge.open("/referee", token=REFEREE)
    judging = Keyboard(judge)
    judging.write(".enter input[name=by]", "Kim")
    judge.press("Enter")
    judging.use(BIG)
    page.phase(Phase.PLAYING)
    page.steer(2)
    page.key_stands(2)
    scripts = page.page.evaluate(PACKED)
    assert all(scripts), "a browser does not say how large they are"
    assert sum(scripts) <= MOST_SCRIPT_BYTES
    assert len(scripts) <= MOST_SCRIPTS
    page.phase(Phase.FINISHED)
    judging.use(BIG)
    judging.use("dialog button[type=submit]")
    page.phase(Phase.OFFICIAL)
    page.sees(".result", "Ants")
    heard = page.page.evaluate("window.heard")
    assert heard[0] == COUNT_HZ
    assert {COUNT_HZ, START_HZ, END_HZ} <= {*heard}
    for shown in (page, judge):
        assert violations(shown.page) == []
        shown.press("?")
        shown.sees("dialog dl")
        assert violations(shown.page) == []
    page.sees("dialog", "More discs win.")
    page.sees("dialog a[href='rules/en']", "All rules")


@pytest.mark.long(minutes=1)
def test_a_match_by_touch_alone(venue: Venue, sit: Sit) -> None:
    """A contestant and a referee play and judge a match with fingers, each on a phone."""
    page = opened(venue, sit, viewport=PHONE, has_touch=True, is_mobile=True)
    page.find("#join-name").tap()
    page.page.keyboard.type(LONG)  # the keyboard that a phone shows
    page.find("button[type=submit]").tap()
    page.stands("seated")
    # What one has to know stands below the field: nothing hides one's own robot.
    page.sees(".rail .brief", "Your robot stands on the left")
    page.misses(".stage .brief")
    venue.contestant("right", "Bees")
    page.is_told("Bees is ready. Press Ready when you are, too")
    page.sees(".events", "Bees is ready")
    page.find("button.ready").tap()
    page.phase(Phase.READY)

    judge = sit(venue.url, viewport=PHONE, has_touch=True, is_mobile=True)
    judge.open("/referee", token=REFEREE)
    judge.find(".enter input[name=by]").tap()
    judge.page.keyboard.type("Kim")
    judge.find(".enter button[type=submit]").tap()
    judge.find(BIG).tap()
    judge.is_toasted("Play begins in 1 second.")
    assert covered(judge.page, ".toast", "button, .clock, .phase, .score-bug") == []
    page.phase(Phase.PLAYING)
    page.find('.key[data-key="2"]').tap()
    page.key_stands(2)
    page.find(".leave").tap()
    page.sees(".leaving", "Leave the match?")
    page.find(".leaving button").last.tap()
    page.phase(Phase.FINISHED)
    judge.find(BIG).tap()
    judge.find("dialog button[type=submit]").tap()
    page.phase(Phase.OFFICIAL)
    # The result has the place of the keys: there is room to scroll, and it covers nothing.
    page.sees(".rail > .result h1", "draw")
    page.misses(".stage .result")
    assert page.find(".pad").is_hidden()
    watcher = sit(venue.url, viewport=PHONE, has_touch=True, is_mobile=True)
    watcher.open("/watch")
    watcher.sees(".result", LONG)
    for shown in (page, judge, watcher):
        assert violations(shown.page) == []
        assert shown.find("kbd:visible").count() == 0, "fingers have no keyboard"
        assert broken_names(shown.page) == []
        expect(shown.find(f".team-name[title='{LONG}']").first).to_be_visible()
    watcher.open("/")
    watcher.sees("h1")
    assert violations(watcher.page) == []
