"""What is said of sensors that do not fit."""

from dataclasses import replace

from gui.view2d.live import Live, words


def test_only_what_changed_is_looked_at(skin):
    live = Live()
    assert live.look(skin) and live.findings == {} and live.problems(skin) == []
    assert not live.look(replace(skin, seed=7))
    assert live.look(replace(skin, sensors=skin.sensors[:1]))


def test_two_too_close_are_said_once_and_an_edge_besides(skin):
    one, two = skin.sensors
    live, crowded = Live(), replace(skin, sensors=(one, replace(two, piece="P1", x=21.0, y=31.0), replace(two, id="C3", x=50.0)))
    live.look(crowded)
    texts = [p.text for p in live.problems(crowded)]
    assert set(live.findings) == {"C1", "C2", "C3"} and len(texts) == 2
    assert "C1 overlaps C2" in texts[0] and "outside piece P2" in texts[1]
    assert words(live.findings["C3"])[0].endswith("outside P2")


def test_a_piece_that_is_gone_is_said(skin):
    live, lost = Live(), replace(skin, sensors=(replace(skin.sensors[0], piece="P9"),))
    live.look(lost)
    assert "P9, which does not exist" in live.problems(lost)[0].text
