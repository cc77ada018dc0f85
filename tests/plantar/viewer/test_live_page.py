"""The page of a stream: on this machine alone, to who has its token, and nothing but its buttons is taken."""

import http.client
import json
import re
import socket
import time

import pytest

from plantar import InputError, hex_layout
from plantar.viewer.live_page import LivePage, _Handler

SOLE = hex_layout([[-0.10, -0.05], [0.14, -0.05], [0.14, 0.05], [-0.10, 0.05]], side="left")


@pytest.fixture
def page():
    with LivePage({"left": SOLE}, "Live: <test>") as served:
        yield served


def ask(page, method: str, path: str, body: str | None = None, **headers: str):
    connection = http.client.HTTPConnection("127.0.0.1", int(page.url.rsplit(":", 1)[1].strip("/")), timeout=5)
    connection.request(method, path, body, {name.replace("_", "-"): value for name, value in headers.items()})
    return connection.getresponse()


def token_of(page) -> str:
    text = ask(page, "GET", "/").read().decode()
    return json.loads(re.search(r'id="data">(.*?)</script>', text)[1])["token"]


def test_the_page_needs_no_network_and_names_its_policy(page):
    answer = ask(page, "GET", "/")
    text = answer.read().decode()
    assert answer.status == 200
    assert "Live: &lt;test&gt;" in text
    assert "connect-src 'self'" in text
    assert not re.search(r'(src|href)="https?:', text)
    assert page._server.server_address[0] == "127.0.0.1"


def test_states_come_in_order_and_the_latest_counts(page):
    answer = ask(page, "GET", f"/stream?token={token_of(page)}")
    for k in range(3):
        page.send({"time": k})
    lines = []
    while not lines or lines[-1] != {"time": 2}:
        line = answer.readline().strip()
        if line.startswith(b"data:"):
            lines.append(json.loads(line[5:]))
    assert [line["time"] for line in lines] == sorted({line["time"] for line in lines})


def states_of(answer):
    """The states that come on a stream, as they are read."""
    while line := answer.readline():
        if line.startswith(b"data:"):
            yield json.loads(line[5:])


def test_what_comes_last_is_shown_without_anything_after_it(page):
    """A second state within one picture is not kept until a third one comes."""
    states = states_of(ask(page, "GET", f"/stream?token={token_of(page)}"))
    for k in range(0, 20, 2):
        page.send({"time": k})
        page.send({"time": k + 1})
        while next(states)["time"] != k + 1:
            pass


def test_states_are_made_for_who_sees_them(page):
    made = []

    def state(k):
        made.append(k)
        return {"time": k}

    for k in range(500):
        page.send(lambda k=k: state(k))
    assert made == []  # nobody sees the page
    streams = [states_of(ask(page, "GET", f"/stream?token={token_of(page)}")) for _ in range(3)]
    assert [next(states)["time"] for states in streams] == [499] * 3
    assert made == [499]


def test_a_viewer_that_does_not_read_finds_no_long_row_of_old_states(page):
    answer = ask(page, "GET", f"/stream?token={token_of(page)}")
    states = states_of(answer)
    sent = 60  # 1.2 MB in all; a client keeps some 130 kB
    for k in range(sent):
        page.send({"time": k, "text": "x" * 20000})
        time.sleep(1.0 / 60.0)
    late = 0
    while next(states)["time"] != sent - 1:
        late += 1
    assert late < sent // 4


def test_a_state_does_not_wait_for_the_one_before_to_be_acknowledged(page, monkeypatch):
    seen = []
    stream = _Handler._stream

    def looked_at(viewer):
        seen.append(viewer.connection.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
        stream(viewer)

    monkeypatch.setattr(_Handler, "_stream", looked_at)
    page.send({"time": 0})
    next(states_of(ask(page, "GET", f"/stream?token={token_of(page)}")))
    assert len(seen) == 1
    assert seen[0] != 0


def test_buttons_count_for_who_has_the_token(page):
    token = token_of(page)
    assert ask(page, "POST", "/do", '{"do": "mark"}', X_Plantar=token).status == 204
    assert ask(page, "POST", "/do", '{"do": "zero"}', X_Plantar=token).status == 204
    assert page.actions() == ["mark", "zero"]
    assert page.actions() == []


def test_strangers_get_nothing(page):
    token = token_of(page)
    assert ask(page, "GET", "/stream").status == 404
    assert ask(page, "GET", "/stream?token=guess").status == 404
    assert ask(page, "GET", "/../../etc/passwd").status == 404
    assert ask(page, "GET", "/", Host="evil.example").status == 403
    assert ask(page, "POST", "/do", '{"do": "zero"}', X_Plantar="guess").status == 403
    assert ask(page, "POST", "/do", '{"do": "zero"}', X_Plantar=token, Host="evil.example").status == 403
    assert ask(page, "POST", "/do", '{"do": "format"}', X_Plantar=token).status == 400
    assert ask(page, "POST", "/do", "[" * 150, X_Plantar=token).status == 400
    assert ask(page, "POST", "/do", "x" * 5000, X_Plantar=token).status == 413
    assert page.actions() == []


def test_a_port_that_is_taken_is_said():
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        with pytest.raises(InputError, match="no page can be served"):
            LivePage({"left": SOLE}, "a", port=other.getsockname()[1])
