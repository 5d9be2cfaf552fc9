"""Words as pictures."""

import numpy as np

from gui.view2d.letters import Letters


def test_words_of_a_size_are_as_high_and_longer_ones_wider():
    letters = Letters()
    short, long, bold = letters.mask("C1", 12), letters.mask("C1 on P2", 12), letters.mask("C1", 12, bold=True)
    assert short.shape[0] == long.shape[0] and long.shape[1] > 2.5 * short.shape[1] and bold.sum() > short.sum()
    assert letters.mask("C1", 12) is short and letters.mask("", 12).max() == 0


def test_letters_stand_side_by_side():
    mask = Letters().mask("lll", 16)
    columns = mask.max(axis=0) > 128
    assert np.count_nonzero(np.diff(np.concatenate([[False], columns, [False]]).astype(int)) == 1) == 3
