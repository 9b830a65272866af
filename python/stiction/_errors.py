"""What goes wrong, and what to know although it went on."""

from __future__ import annotations


class StictionError(Exception):
    """Input that cannot be taken, in four parts: what it is, where, what was found, what is allowed.

    `code` has a page in docs/codes; `place` is a file with line and column, or the name of an argument.
    """

    code: str
    place: str
    found: str
    allowed: str

    def __init__(self, code: str, place: str, found: str, allowed: str) -> None:
        super().__init__(code, place, found, allowed)
        self.code = code
        self.place = place
        self.found = found
        self.allowed = allowed

    def __str__(self) -> str:
        place = f"{self.place}: " if self.place else ""
        allowed = f"; {self.allowed}" if self.allowed else ""
        return f"[{self.code}] {place}{self.found}{allowed}"


class StictionWarning(UserWarning):
    """What a user should know although the work went on; `code` has a page in docs/codes.

    The text begins with the code in brackets, so that one kind can be silenced:
    `warnings.filterwarnings("ignore", r"\\[quantisation\\]", stiction.StictionWarning)`.
    """

    code: str
    message: str

    def __init__(self, code: str, message: str) -> None:
        super().__init__(code, message)
        self.code = code
        self.message = message

    def __str__(self) -> str:
        return f"[{self.code}] {self.message}"


def kind_of(value: object) -> str:
    """What a value is, in words: `a list`, `an int`, `None`."""
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{'an' if name[0] in 'aeioAEIO' else 'a'} {name}"


def argument(place: str, found: str, allowed: str) -> StictionError:
    """An argument that cannot be taken."""
    return StictionError("usage", place, found, allowed)
