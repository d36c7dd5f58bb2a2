"""What ends a run: each code has words, for any engine."""

import pytest

from contactlaw.stepping import Trouble
from contactlaw.stepping.trouble import MESSAGES, explain


@pytest.mark.parametrize("code", Trouble)
def test_a_code_has_words_that_say_where_it_was_and_what_to_do(code):
    words = explain(code, 3, 2.5, 0.5, bead=7, step=11)
    assert words.startswith("bead 7 on wall 3 at step 11: ") and not {*"{}"} & {*words}
    assert explain(code, -1, 2.5, 0.5) == words.partition(": ")[2]
    remedies = "take ", "place ", "give ", "make room", "use ", "keep ", "change ", "fit into", "blown up", "no finite"
    assert any(remedy in words for remedy in remedies)
    assert "plate" not in words.replace("plates", "")  # a word for walls of any engine


def test_no_words_are_without_a_code():
    assert {*MESSAGES} == {*Trouble}
