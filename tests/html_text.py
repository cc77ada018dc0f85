"""What a page's text holds, without a browser: whether all that is opened is closed, and which addresses it names."""

from html.parser import HTMLParser

ALONE = ("meta", "link", "br", "img", "path", "circle")
"""Elements that have no end."""


class _Balanced(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.addresses += [v or "" for k, v in attrs if k in ("src", "href", "srcset", "action")]
        if tag not in ALONE:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in ALONE:
            assert self.open.pop() == tag


def addresses_of(text: str) -> list[str]:
    """All addresses of a page, every element of which must be closed in its place."""
    page = _Balanced()
    page.feed(text)
    assert page.open == []
    return page.addresses
