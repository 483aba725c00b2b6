"""Messages from Python values: keyword arguments to fields, enums by their lower-case names.

>>> from phrenic.v1 import parameters_pb2
>>> message = fill(parameters_pb2.Parameters(), {"breath_force": 1.5, "integrator": "velocity_verlet"}, "parameter")
>>> values(message)
{'breath_force': 1.5, 'integrator': 'velocity_verlet'}
>>> fill(parameters_pb2.Parameters(), {"breath_forse": 1}, "parameter")
Traceback (most recent call last):
    ...
phrenic.errors.InvalidArgument: there is no parameter breath_forse: did you mean breath_force?
"""

from __future__ import annotations

import difflib
from typing import Any, Iterable, Mapping, TypeVar

from google.protobuf.descriptor import EnumDescriptor, FieldDescriptor
from google.protobuf.message import Message

from .arguments import mapping, text_of
from .errors import InvalidArgument, NotFound

M = TypeVar("M", bound=Message)


def nearest(name: str, known: Iterable[str]) -> str:
    """Returns "did you mean X?" for a misspelt name, or the list of known names."""
    known = list(known)
    near = difflib.get_close_matches(name, known, 1)
    if near:
        return f"did you mean {near[0]}?"
    return "there are " + ", ".join(known) if known else "there are none"


def look_up(table: Mapping[str, Any], name: str, what: str) -> Any:
    """Returns table[name]. NotFound names the nearest or the existing ones."""
    if name in table:
        return table[name]
    text_of(what, name)
    raise NotFound(f"there is no {what} {name}: {nearest(name, table)}")


class Named(dict[str, Any]):
    """Values by name. A name that is not there is a KeyError with the nearest one.

    >>> Named({"hd95_max": 1.0}, "distance")["hd95"]
    Traceback (most recent call last):
        ...
    KeyError: 'there is no distance hd95: did you mean hd95_max?'
    """

    def __init__(self, values: Mapping[str, Any], what: str) -> None:
        super().__init__(values)
        self._what = what

    def __missing__(self, name: Any) -> Any:
        raise KeyError(f"there is no {self._what} {name}: {nearest(str(name), self)}")


def is_repeated(field: FieldDescriptor) -> bool:
    """True if the field is a list. Newer versions of protobuf have another name for it."""
    return bool(field.is_repeated if hasattr(field, "is_repeated") else field.label == field.LABEL_REPEATED)


def _prefix(enum: EnumDescriptor) -> str:
    """The common prefix of an enum's names: INTEGRATOR_ of INTEGRATOR_UNSPECIFIED."""
    return enum.values_by_number[0].name[: -len("UNSPECIFIED")]


def enum_number(enum: EnumDescriptor, name: Any) -> int:
    """Returns the number of a value by its lower-case name; numbers stay as they are."""
    if isinstance(name, int):
        return name
    value = enum.values_by_name.get(_prefix(enum) + str(name).upper())
    if value is None:
        raise InvalidArgument(f"there is no {enum.name.lower()} {name}: {nearest(str(name), enum_names(enum))}")
    return value.number


def enum_names(enum: EnumDescriptor) -> list[str]:
    """Returns the lower-case names of an enum's values."""
    return [v.name[len(_prefix(enum)) :].lower() for v in enum.values if v.number != 0]


def enum_name(enum: EnumDescriptor, number: int) -> str:
    """Returns the lower-case name of a value; empty for one that is not set."""
    value = enum.values_by_number.get(number)
    return value.name[len(_prefix(enum)) :].lower() if value and number else ""


def fill(message: M, fields: Mapping[str, Any], what: str = "option") -> M:
    """Sets fields of `message` and returns it. None leaves a field unset. InvalidArgument for an unknown field or a
    value of another type; ranges are checked by the server."""
    for name, value in mapping(what, fields).items():
        field = message.DESCRIPTOR.fields_by_name.get(text_of(what, name))
        if field is None:
            raise InvalidArgument(f"there is no {what} {name}: {nearest(name, message.DESCRIPTOR.fields_by_name)}")
        if value is None:
            continue
        try:
            _set(message, field, value)
        except InvalidArgument as error:
            raise InvalidArgument(f"{name}: {error.message}") from None
        except TypeError as error:
            raise InvalidArgument(f"{name}: {value!r} is of the wrong type: {error}") from None
        except (ValueError, OverflowError) as error:
            raise InvalidArgument(f"{name}: {value!r} is outside the range of its type: {error}") from None
    return message


def _set(message: Message, field: FieldDescriptor, value: Any) -> None:
    convert = (lambda v: enum_number(field.enum_type, v)) if field.enum_type else (lambda v: v)
    if is_repeated(field):
        if isinstance(value, str):  # its letters would be taken one by one
            raise InvalidArgument(f"give a list: [{value!r}]")
        getattr(message, field.name).extend(convert(each) for each in value)
    else:
        setattr(message, field.name, convert(value))


def values(message: Message) -> dict[str, Any]:
    """Returns the fields of a flat message that are set, enums by name."""
    return {field.name: _plain(field, value) for field, value in message.ListFields()}


def row(message: Message) -> dict[str, Any]:
    """Returns every field of a flat message; None for an optional one that is not set."""
    return {
        field.name: None
        if field.has_presence and not message.HasField(field.name)
        else _plain(field, getattr(message, field.name))
        for field in message.DESCRIPTOR.fields
        if field.message_type is None
    }


def _plain(field: FieldDescriptor, value: Any) -> Any:
    if is_repeated(field):
        return list(value)
    return enum_name(field.enum_type, value) if field.enum_type else value
