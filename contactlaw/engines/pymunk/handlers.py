"""Collision handlers of the user beside the adapter's, so that neither replaces the other."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pymunk

Callback = Callable[["pymunk.Arbiter", "pymunk.Space", Any], None]
Key = tuple[int | None, int | None]  # two collision types; None: any
Hook = tuple[Callback, Any]  # a pre_solve of the user, and the data to call it with


class Handlers:
    """Replacement of ``space.on_collision`` from `attach` to `detach`.

    pymunk keeps one ``pre_solve`` for each key, the last one given. A user's ``pre_solve`` for a
    key of the adapter becomes a hook that the adapter's calls first. One for a wildcard, or for the
    two types in the other order, is called by pymunk after the adapter's, when the restitution is
    set and the impact recorded: the adapter wraps it, to notice what it changes.
    """

    def __init__(self, space: pymunk.Space, contacts: Any, bead: int, plate: int) -> None:
        self._space, self._contacts, self._bead = space, contacts, bead
        self._stranger: Callback | None = contacts.meet_stranger
        self._keys = 0  # keys of the space whose types are watched
        self._strange: set[int] = set()
        # keys whose callbacks pymunk calls after the adapter's
        self._late = (None, None), (bead, None), (plate, None), (plate, bead)
        self._watched: dict[Key, Hook] = {}
        self._replaced = vars(space).get("on_collision")
        self._engine = space.on_collision
        self._hooks: dict[Key, list[Hook]] = {(bead, plate): [], (bead, bead): []}
        self._own: dict[Key, Callback] = {
            (bead, plate): contacts.on_plates(self._hooks[bead, plate]),
            (bead, bead): contacts.on_beads(self._hooks[bead, bead]),
        }
        earlier = space._handlers.get((None, None))  # the only key that can be older than ours
        if earlier is not None and earlier.pre_solve is not None:
            self.on_collision(None, None, pre_solve=earlier.pre_solve, data=earlier.data["pre_solve"])
        for key, callback in self._own.items():
            self._engine(*key, pre_solve=callback)
        self._installed = [(key, space._handlers[key], own) for key, own in self._own.items()]
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
        given = pre_solve
        if given is not None:
            hook = None if given == pymunk.empty_callback else (given, data)
            if key in self._own:
                self._hooks[key][:] = [hook] if hook else []
                pre_solve = None
            elif key in self._late:
                self._watched.pop(key, None)
                if hook:
                    self._watched[key] = hook
                    pre_solve = self._watch(key, given)
        self._engine(*key, begin, pre_solve, post_solve, separate, data)

    def check(self) -> None:
        """Make hooks of handlers that ``pymunk.Space.on_collision(space, ...)`` has set."""
        if self._stranger is not None and len(self._space._handlers) != self._keys:
            self._watch_strangers(self._stranger)
        for key, handler, callback in self._installed:
            found = handler.pre_solve
            if found is not callback:
                self._hooks[key][:] = [] if found is None else [(found, handler.data["pre_solve"])]
                handler.pre_solve = callback

    def _watch_strangers(self, stranger: Callback) -> None:
        """Watch beads at shapes of type 0 and of all types for which there are handlers.

        A handler for two types costs nothing in other contacts, as one for any type would.
        """
        own = {kind for key in self._own for kind in key}
        kinds = {0, *(kind for key in self._space._handlers for kind in key)} - own - {None}
        for kind in kinds - self._strange:
            known = self._space._handlers.get((self._bead, kind))
            if known is None or known.post_solve is None:
                self._engine(self._bead, kind, post_solve=stranger)
            self._strange.add(kind)
        self._keys = len(self._space._handlers)

    def ignore_strangers(self) -> None:
        """Stop watching for shapes that are not registered."""
        import pymunk

        for kind in self._strange:
            if self._space._handlers[self._bead, kind].post_solve == self._stranger:
                self._engine(self._bead, kind, post_solve=pymunk.empty_callback)
        self._stranger = None

    def replaced(self) -> bool:
        """Whether the user has replaced ``space.on_collision``."""
        return vars(self._space).get("on_collision") != self.on_collision

    def detach(self) -> None:
        """Remove the adapter's handlers from the space; the user's stay."""
        import pymunk

        state = vars(self._space)
        del state["on_collision"]
        if self._replaced:
            state["on_collision"] = self._replaced
        self.ignore_strangers()
        for key, hooks in self._hooks.items():
            callback, data = hooks[0] if hooks else (pymunk.empty_callback, None)
            self._engine(*key, pre_solve=callback, data=data)
        for key, (callback, data) in self._watched.items():
            self._engine(*key, pre_solve=callback, data=data)

    def _watch(self, key: Key, callback: Callback) -> Callback:
        """Wrap a user's callback, to notice what it changes in a contact of the adapter's."""
        contacts = self._contacts

        def pre_solve(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
            try:
                processed, restitution = arbiter.process_collision, arbiter.restitution
                rubbing = arbiter.friction, arbiter.surface_velocity
                callback(arbiter, space, data)
                if not contacts.is_ours(arbiter):
                    return
                if arbiter.restitution != restitution:
                    given, arbiter.restitution = arbiter.restitution, restitution
                    raise overridden(key, "restitution", given)
                if processed and not arbiter.process_collision:
                    contacts.undo(arbiter)
                elif rubbing != (arbiter.friction, arbiter.surface_velocity):
                    contacts.rub(arbiter)
            except BaseException as error:
                contacts.keep(error)

        return pre_solve


def overridden(key: Key, name: str, value: float) -> RuntimeError:
    """Make the error for a handler that sets a restitution or friction in place of the model."""
    remedy = {
        "restitution": "a model of its own: add_plate(..., model=...), any object with curve()",
        "friction": "a friction of its own: add_plate(..., friction=...), None for the engine's",
    }[name]
    return RuntimeError(
        f"pre_solve of {key}: sets arbiter.{name} to {value!r} where a bead hits, but there the "
        f"model answers; do not set it, and give a plate that differs {remedy}"
    )
