"""What the keys do, and what this is."""

from skinfab import __version__


def test_the_list_names_every_key(person):
    person.press("F1")
    (said,) = person.answers.asked
    for action in person.app.actions.all:
        if action.key:
            assert f":  {action.label.removesuffix(' …')}" in said, action.id
    assert "Ctrl+O:  Open" in said and "drag turns" in said


def test_about(person):
    person.app.actions.do("about")
    assert f"skinfab {__version__}" in person.answers.asked[0] and "GPL-3.0" in person.answers.asked[0]
