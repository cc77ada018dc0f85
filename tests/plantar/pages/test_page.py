"""What pages are made of."""

from plantar.pages.page import row, table


def test_columns_of_words_are_told_from_columns_of_numbers():
    head = ("Recording", "Participant", "Value", "Note")
    html = table("x", "What it is", head, [row("a.asc", ["P1", "3", "odd"])], words=("Participant", "Note"))
    assert '<table class="words-2 words-4">' in html
    assert "<table>" in table("x", "What it is", head, [])
