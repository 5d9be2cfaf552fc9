"""What is equal stays the same object; what changed is new."""

import pickle
from dataclasses import replace

import numpy as np

from gui.state.adopt import adopt


def test_all_that_is_equal_is_taken_over(skin):
    back = pickle.loads(pickle.dumps(skin))
    adopted = adopt(skin, back)
    assert adopted.mesh is skin.mesh and adopted.seams is skin.seams
    assert all(a is b for a, b in zip(adopted.pieces, skin.pieces, strict=True))
    assert all(a is b for a, b in zip(adopted.sensors, skin.sensors, strict=True))


def test_what_changed_is_new(skin):
    other = replace(skin.pieces[1], UV=skin.pieces[1].UV + 1)
    back = pickle.loads(
        pickle.dumps(replace(skin, pieces=(skin.pieces[0], other), sensors=skin.sensors[:1], seams=np.zeros((0, 2), dtype=np.int64)))
    )
    adopted = adopt(skin, back)
    assert adopted.pieces[0] is skin.pieces[0] and adopted.pieces[1] is back.pieces[1]
    assert adopted.seams is back.seams and len(adopted.sensors) == 1
