"""Exceptions, with the messages of the program."""
from __future__ import annotations


class InputError(ValueError):
    """A mistake in what was asked: a scene, a file, an argument.

    mistakes: all that were found, each as (file, line, message); line is 0 where it means nothing.
    """

    mistakes: list[tuple[str, int, str]] = []


class SolverError(RuntimeError):
    """A numerical method did not do its work; the message has the library's own description."""
