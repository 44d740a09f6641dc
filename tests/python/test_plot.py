"""Pictures have in them what they are of."""
import matplotlib

matplotlib.use("Agg")
import matplotlib.collections
import numpy as np
import pytest

import eigengrain.plot


def only(axes, kind):
    (found,) = [artist for artist in axes.collections if type(artist) is kind]
    return found


def test_force_chains_have_a_line_for_each_contact_of_the_slice(small, tmp_path):
    axes = eigengrain.plot.force_chains(small, slice=(-1, 1))
    lines = only(axes, matplotlib.collections.LineCollection)
    contacts = small.contacts
    assert len(lines.get_segments()) == len(contacts)
    np.testing.assert_allclose(lines.get_array(), np.sort(contacts.normal_force))
    balls = only(axes, matplotlib.collections.EllipseCollection)
    assert len(balls.get_offsets()) == len(small.bodies)
    start, end = lines.get_segments()[-1]  # the largest force, in mm
    strongest = np.argmax(contacts.normal_force)
    branch = contacts.branch[strongest][[0, 2]]
    np.testing.assert_allclose(end - start, 1e3 * branch, atol=1e-9)
    axes.figure.savefig(tmp_path / "chains.png")
    assert (tmp_path / "chains.png").stat().st_size > 10_000
    thin = eigengrain.plot.force_chains(small, plane="xy", balls=False)
    assert 0 < len(only(thin, matplotlib.collections.LineCollection).get_segments()) < len(contacts)


def test_mode_shapes_point_where_balls_go(small):
    modes = small.system().lowest_modes(2)
    axes = eigengrain.plot.mode_shape(small, modes, 1, slice=(-1, 1))
    (arrows,) = [a for a in axes.collections if isinstance(a, matplotlib.quiver.Quiver)]
    u, _ = modes.motion(1)
    length = np.hypot(arrows.U, arrows.V)
    assert length.max() == pytest.approx(2e3 * small.bodies.radius.mean(), rel=1e-9)
    np.testing.assert_allclose(np.sort(length / length.max()),
                               np.sort(np.hypot(u[:, 0], u[:, 2])) / np.hypot(u[:, 0], u[:, 2]).max(), atol=1e-9)


def test_density_with_its_errors(small):
    system = small.system()
    density = system.density_of_states(bins=8, moments=64, vectors=4)
    axes = eigengrain.plot.density_of_states(density, frequencies=system.all_modes().frequencies)
    (line,) = [container for container in axes.containers][0].lines[:1]
    np.testing.assert_allclose(line.get_ydata(), 1e3 * density.density)
    assert {text.get_text() for text in axes.get_legend().get_texts()} == {"kernel polynomial method",
                                                                          "every mode, counted"}


def test_spectra_and_timesteps(small):
    system = small.system()
    axes = eigengrain.plot.participation(system.lowest_modes(5), system.highest_modes(5))
    assert sum(len(points.get_offsets()) for points in axes.collections) == 10
    found = small.timestep()
    axes = eigengrain.plot.timesteps(found)
    assert [label.get_text() for label in axes.get_yticklabels()] == [
        e.name for e in sorted(found.estimates, key=lambda e: e.ratio_to_true)]
