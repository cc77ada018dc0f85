"""Patches, readings and the wrenches on links, against sums taxel by taxel."""

import numpy as np
import pytest

from plantar.errors import InputError, LayoutError
from plantar.sensing.link_skin import BodySkin, SkinPatch, link_wrenches


def patch(name, link, count, seed=0, **options):
    """Taxels anywhere, turned anyhow."""
    rng = np.random.default_rng(seed)
    rotations = np.linalg.qr(rng.normal(size=(count, 3, 3)))[0]
    return SkinPatch(name, link, rng.normal(size=(count, 3)), rotations, np.full(count, 7e-4), **options)


def test_a_skin_is_ordered_by_link():
    skin = BodySkin([patch("a", "hand", 3), patch("b", "arm", 2, 1), patch("c", "hand", 4, 2)])
    assert skin.links == ("arm", "hand")
    assert skin.link_of.tolist() == [0] * 2 + [1] * 7
    assert skin.slices["c"] == slice(5, 9)
    assert len(skin) == 9


def test_wrenches_are_the_sums_of_the_active_taxels_alone():
    skin = BodySkin([patch("a", "hand", 5), patch("b", "arm", 4, 1), patch("c", "foot", 3, 2)])
    rng = np.random.default_rng(3)
    force = rng.uniform(0.0, 5.0, 12)
    active = rng.random(12) < 0.6
    active[skin.slices["c"]] = False
    found = link_wrenches(skin, force, active)
    assert [w.link for w in found] == ["arm", "hand"]
    for link, wrench, taxels in found:
        expected = np.zeros(6)
        for i in np.flatnonzero(active & (skin.link_of == skin.links.index(link))):
            push = force[i] * skin.normals[i]
            expected += [*push, *np.cross(skin.positions[i], push)]
        assert np.allclose(wrench, expected, atol=1e-12)
        assert active[taxels].all()


def test_silence_makes_no_wrench():
    skin = BodySkin([patch("a", "hand", 5)])
    assert link_wrenches(skin, np.ones(5), np.zeros(5, dtype=bool)) == []


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"positions": np.zeros((2, 3))}, "patch 'a': rotations"),
        ({"positions": np.full((3, 3), np.nan)}, "patch 'a': positions"),
        ({"areas": np.zeros(3)}, "patch 'a': an area is 0 m^2; allowed: above 0"),
        ({"rotations": np.full((3, 3, 3), 0.5)}, "patch 'a': a rotation is not orthonormal"),
        ({"proximity_range": -0.02}, "patch 'a': proximity range is -0.02 m; allowed: 0 or more"),
        ({"force_threshold": np.nan}, "patch 'a': force threshold is nan N"),
    ],
)
def test_a_bad_patch_is_named(change, words):
    good = {"positions": np.zeros((3, 3)), "rotations": np.tile(np.eye(3), (3, 1, 1)), "areas": np.full(3, 1e-4)}
    with pytest.raises(LayoutError, match="patch 'a'") as caught:
        SkinPatch("a", "hand", **(good | change))
    assert str(caught.value).startswith(words)
    assert "\n" not in str(caught.value)


def test_patches_need_names_of_their_own():
    with pytest.raises(LayoutError, match="two patches are called 'a'"):
        BodySkin([patch("a", "hand", 3), patch("a", "arm", 2)])
    with pytest.raises(LayoutError, match="no patches"):
        BodySkin([])


def test_an_unknown_patch_is_named_with_those_there_are():
    skin = BodySkin([patch("palm", "hand", 3), patch("back", "hand", 2)])
    with pytest.raises(InputError, match="no patch is called 'plam'; allowed: palm, back"):
        skin.taxels_of(["plam"])
