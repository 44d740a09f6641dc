"""Scenes that the tests share."""
import os
import pathlib

import pytest

import eigengrain

EXAMPLES = pathlib.Path(os.environ["EIGENGRAIN_EXAMPLES"])


def two_balls(**keys):
    """A ball on a floor and one above it that touches it, as a dict."""
    return {"gravity": [0, 0, -9.81],
            "materials": [{"name": "grain", "density": 2500}],
            "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4, "friction": 0.5}],
            "balls": [{"position": [0, 0, "4.99 mm"], "radius": 0.005, "material": "grain"},
                      {"position": [0, 0, 0.01497], "radius": "5 mm", "material": "grain"}],
            "walls": [{"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "material": "grain"}]} | keys


def dense_packing(box=0.045, seed=1, friction=0.5):
    """Some hundred balls of many sizes, pressed in a periodic cell, as a dict."""
    return {"materials": [{"name": "grain", "density": 2500}],
            "contacts": [{"between": ["grain", "grain"], "law": "linear", "kn": 1e5, "ks": 5e4,
                          "friction": friction}],
            "periodic": {"box": [box] * 3},
            "balls": [{"fill": "dense", "mean_overlap": 1e-3, "seed": seed, "material": "grain",
                       "sizes": {"distribution": "lognormal", "mean": 4.6e-3, "deviation": 0.5e-3, "min": 3e-3,
                                 "max": 7e-3}}]}


@pytest.fixture(scope="session")
def examples():
    return EXAMPLES


@pytest.fixture(scope="session")
def bed():
    """10,000 balls settled in an open box."""
    return eigengrain.load(EXAMPLES / "scenes" / "packing_10k.yaml")


@pytest.fixture(scope="session")
def packing():
    """1,000 balls of many sizes in a periodic cell."""
    return eigengrain.load(EXAMPLES / "scenes" / "dense_packing.yaml")


@pytest.fixture(scope="session")
def small():
    """Some hundred balls, for what costs the cube of their number."""
    return eigengrain.load(dense_packing())
