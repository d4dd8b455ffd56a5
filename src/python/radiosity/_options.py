"""Options of the library's lists that the signature of a function does not name."""

from __future__ import annotations

import inspect
from typing import Any, Callable, Sequence, TypeVar, Union

from . import _core

Function = TypeVar("Function", bound=Callable[..., Any])


def takes_options(*stages: str) -> Callable[[Function], Function]:
    """For a function with `**more`: its signature and documentation name what more() takes."""
    def documented(function: Function) -> Function:
        signature = inspect.signature(function)
        given = [p for p in signature.parameters.values() if p.kind is not p.VAR_KEYWORD]
        names = {p.name for p in given}
        others = [option for option in _options_of(stages) if option["name"] not in names]
        added = [inspect.Parameter(option["name"], inspect.Parameter.KEYWORD_ONLY, default=option["value"],
                                   annotation=_type_name(option["value"])) for option in others]
        function.__signature__ = signature.replace(parameters=given + added)  # type: ignore[attr-defined]
        function.__doc__ = (function.__doc__ or "") + "".join(
            f"\n    {option['name']}: {option['help']}." for option in others)
        return function
    return documented


def _type_name(value: Any) -> str:
    return "Any" if value is None else type(value).__name__


def more(stages: Union[str, Sequence[str]], given: dict, function: str = "") -> dict:
    """`given`, what a function found in its `**more`. TypeError for what is no option of the stages,
    of which the one has the function's name if it is not told."""
    known = {option["name"] for option in _options_of([stages] if isinstance(stages, str) else stages)}
    for name in given:
        if name not in known:
            raise TypeError(f"{function or stages}() got an unexpected keyword argument {name!r}")
    return given


def _options_of(stages: Sequence[str]) -> list:
    return [option for stage in stages for option in _core.options(stage) if option["help"]]
