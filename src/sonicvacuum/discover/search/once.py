"""What a search worked out of its fits: several of its moves begin with the same sets less one effect."""

from collections.abc import Callable, Hashable, Iterable

from sonicvacuum.discover.fit.refit import Fit


class Once:
    """Results by fit, the very object, and by name; they are shared, and must not be changed."""

    def __init__(self):
        self._known: dict[int, tuple[Fit, dict]] = {}

    def of(self, fit: Fit, what: Hashable, work: Callable):
        """The result of `work()`, which goes by the name `what`."""
        (result,) = self.of_each(fit, [what], lambda _: [work()])
        return result

    def of_each(self, fit: Fit, names: Iterable[Hashable], work: Callable) -> list:
        """Results by name; those that are not known come from `work(names)`, in their order."""
        known = self._known.setdefault(id(fit), (fit, {}))[1]
        names = list(names)
        new = [name for name in names if name not in known]
        if new:
            known.update(zip(new, work(new), strict=True))
        return [known[name] for name in names]
