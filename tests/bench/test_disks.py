import numpy as np
import pytest

from skinfab.bench.disks import LEAST, MOST, bumpy_cap
from skinfab.errors import InputError
from skinfab.flatten.bff import require_disk
from skinfab.flatten.distortion import shaped_areas
from skinfab.mesh.topology import Topology


@pytest.mark.parametrize("asked", [LEAST, 300, 5_000])
def test_a_disk_of_about_the_size_that_was_asked_for(asked: int) -> None:
    V, F = bumpy_cap(asked)
    assert len(require_disk(Topology(F), len(V))) == 6 * round((len(F) / 6) ** 0.5)
    assert abs(len(F) - asked) < 0.1 * asked
    assert shaped_areas(V, F)[1].all()


def test_the_surface_is_the_same_at_every_size_and_faces_outwards() -> None:
    areas = []
    for size in (2_400, 9_600):
        V, F = bumpy_cap(size)
        p = V[F]
        normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]) / 2
        assert (np.einsum("ij,ij->i", normal, p.mean(axis=1)) > 0).all()
        areas.append(np.linalg.norm(normal, axis=1).sum())
    assert areas[0] == pytest.approx(areas[1], rel=0.01)


@pytest.mark.parametrize("size", [0, LEAST - 1, MOST + 1])
def test_sizes_out_of_range_are_told(size: int) -> None:
    with pytest.raises(InputError, match=f"{size} triangles is not made; give {LEAST} to {MOST}"):
        bumpy_cap(size)
