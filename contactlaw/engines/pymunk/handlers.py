"""Collision handlers of the user beside the adapter's, so that neither replaces the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pymunk

Callback = Callable[["pymunk.Arbiter", "pymunk.Space", Any], None]
Key = tuple[int | None, int | None]  # two collision types; None: any


class Handlers:
    """Replacement of ``space.on_collision`` from `attach` to `detach`.

    pymunk keeps one callback for each key and phase, and prints the errors of callbacks. The user's
    ``pre_solve`` for a key of the adapter is called after the adapter's. Every callback of the user is
    called by `_call`, so that its error is raised by the step.
    """

    def __init__(self, space: pymunk.Space, contacts: Any, bead: int, plate: int) -> None:
        self._contacts = contacts
        self._engine: Any = space.on_collision
        self._users: dict[tuple[Key, str], Any] = {}  # callbacks, and the data to call them with
        self._own = (bead, plate), (bead, bead)
        for key in self._own:
            self._engine(*key, pre_solve=self._pre_solve, data=key)

    def _pre_solve(self, arbiter: pymunk.Arbiter, space: pymunk.Space, key: Key) -> None:
        self._contacts.answer(arbiter)
        if hook := self._users.get((key, "pre_solve")):
            self._call(arbiter, space, hook)

    def _call(self, arbiter: pymunk.Arbiter, space: pymunk.Space, hook: Any) -> None:
        """Call a callback of the user, and keep its error for the end of the step."""
        callback, data = hook
        try:
            callback(arbiter, space, data)
        except BaseException as error:
            self._contacts.keep(error)

    def on_collision(
        self,
        collision_type_a: int | None = None,
        collision_type_b: int | None = None,
        *,
        data: Any = None,
        **phases: Callback | None,
    ) -> None:
        """Set handlers as pymunk's ``on_collision`` does, but keep the adapter's ``pre_solve``."""
        key = collision_type_a, collision_type_b
        for phase, callback in phases.items():
            if callback is not None:
                hook = self._users[key, phase] = callback, data
                if phase != "pre_solve" or key not in self._own:
                    self._engine(*key, **{phase: self._call}, data=hook)

    def detach(self) -> None:
        """Remove the adapter's handlers from the space; the user's stay."""
        import pymunk

        for own in self._own:
            self._engine(*own, pre_solve=pymunk.empty_callback)
        for (key, phase), (callback, data) in self._users.items():
            self._engine(*key, **{phase: callback}, data=data)
