"""Pages state a policy that holds for their own scripts and for no other."""

import base64
import hashlib
import re

from plantar.common.pages.page import Section, page, with_policy


def test_a_page_allows_its_own_scripts_alone():
    code = "document.title = 'a';"
    text = page("A title", "", [Section("a", "A", "<p>text</p>")], script=f"<script>{code}</script>")
    policy = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', text)
    digest = base64.b64encode(hashlib.sha256(code.encode()).digest()).decode()
    assert len(policy) == 1
    assert f"script-src 'sha256-{digest}'" in policy[0]
    for rule in ("default-src 'none'", "connect-src 'none'", "form-action 'none'", "base-uri 'none'"):
        assert rule in policy[0]
    assert "unsafe-inline" not in policy[0].partition("script-src")[2]
    assert text.index("Content-Security-Policy") < text.index("<style>")


def test_a_page_without_scripts_runs_none_and_data_is_no_script():
    data = '<head></head><script type="application/json" id="d">{"a": 1}</script>'
    assert "script-src 'none'" in with_policy(data)
