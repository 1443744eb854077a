"""The pure parts of the pages, in Node: no browser is needed."""

from chromium import npm


def test_the_pure_parts_of_the_pages() -> None:
    """Each case is in tests/pages/core; the output names those that fail."""
    npm("test")
