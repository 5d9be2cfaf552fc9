"""Every fault becomes one sentence."""

import pytest

from gui.jobs.worker import outcome_of
from skinfab.errors import InputError


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        (InputError("cup.obj: no such file"), "cup.obj: no such file"),
        (MemoryError(), "not enough memory"),
        (FileNotFoundError(2, "No such file or directory", "a.obj"), "a.obj: No such file or directory"),
        (RuntimeError("boom"), "unexpected RuntimeError: boom"),
    ],
)
def test_a_fault_is_a_sentence(fault, sentence):
    def work():
        raise fault

    outcome = outcome_of(work)
    assert outcome.result is None and outcome.sentence.startswith(sentence)
    assert bool(outcome.trace) == isinstance(fault, RuntimeError)
