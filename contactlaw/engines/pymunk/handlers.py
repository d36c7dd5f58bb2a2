"""Collision handlers of the user beside the adapter's, so that neither replaces the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pymunk

Callback = Callable[["pymunk.Arbiter", "pymunk.Space", Any], None]
Key = tuple[int | None, int | None]  # two collision types; None: any
Hook = tuple[Callback, Any]  # a callback of the user, and the data to call it with


class Handlers:
    """Replacement of ``space.on_collision`` from `attach` to `detach`.

    pymunk keeps one callback for each key and phase, and prints the errors of callbacks. The adapter's
    ``pre_solve`` calls the user's ``pre_solve`` for the same key first. Every other callback of the user is
    wrapped, so that its error is raised by the step.
    """

    def __init__(self, space: pymunk.Space, contacts: Any, bead: int, plate: int) -> None:
        self._space, self._contacts, self._stranger = space, contacts, (bead, 0)
        self._replaced = vars(space).get("on_collision")
        self._engine: Any = space.on_collision
        self._users: dict[tuple[Key, str], Hook] = {}
        self._hooks: dict[Key, list[Hook]] = {(bead, plate): [], (bead, bead): []}
        for key, hooks in self._hooks.items():
            self._engine(*key, pre_solve=contacts.pre_solve, data=hooks)
        self._engine(*self._stranger, post_solve=contacts.meet_stranger)
        vars(space)["on_collision"] = self.on_collision

    def on_collision(
        self,
        collision_type_a: int | None = None,
        collision_type_b: int | None = None,
        begin: Callback | None = None,
        pre_solve: Callback | None = None,
        post_solve: Callback | None = None,
        separate: Callback | None = None,
        data: Any = None,
    ) -> None:
        """Set handlers as pymunk's ``on_collision`` does, but keep the adapter's ``pre_solve``."""
        import pymunk

        key = collision_type_a, collision_type_b
        phases = {"begin": begin, "pre_solve": pre_solve, "post_solve": post_solve, "separate": separate}
        for phase, callback in phases.items():
            if callback is None:
                continue
            self._users[key, phase] = callback, data
            taken_back = callback == pymunk.empty_callback
            if phase == "pre_solve" and key in self._hooks:
                self._hooks[key][:] = [] if taken_back else [(callback, data)]
            else:
                self._engine(*key, **{phase: callback if taken_back else self._guarded(callback)}, data=data)

    def _guarded(self, callback: Callback) -> Callback:
        """Make a callback keep its error for the end of the step."""

        def guarded(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                callback(arbiter, space, data)
            except BaseException as error:
                self._contacts.keep(error)

        return guarded

    def detach(self) -> None:
        """Remove the adapter's handlers from the space; the user's stay."""
        import pymunk

        state = vars(self._space)
        del state["on_collision"]
        if self._replaced:
            state["on_collision"] = self._replaced
        for key in self._hooks:
            self._engine(*key, pre_solve=pymunk.empty_callback)
        self._engine(*self._stranger, post_solve=pymunk.empty_callback)
        for (key, phase), (callback, data) in self._users.items():
            self._engine(*key, **{phase: callback}, data=data)
