"""Records of liebench as a pandas table.

    runs = read_records("results/cost_accuracy.jsonl")
    runs.loc[runs["options.k"] == 3, ["step_size", "errors.q.end_relative", "time.total_ns"]]

One row a run, for a run is what has a cost: its errors stand beside it as columns. `errors_of` makes one row an error of it.

A column has the name that docs/records.md gives the quantity, "time.ns_per_step.median" for instance, and all columns of the
format are there whatever a file holds. What a record lacks is NaN (of a date NaT): errors of a failed run, lambda without
constraints, times in extended precision. Types:

- numbers are float64, counts too (they are exact below 2^53), and `steps` is int64;
- words are categories (outcome, formulation, integrator, ...), but for `key` and `failure.message`, which are str;
- "time.unsteady" and "provenance.dirty" are bool; "time.unsteady" is also False for a run without a time;
- "provenance.date" is a time in UTC;
- "time.ns_per_step.samples" holds lists: runs.explode("time.ns_per_step.samples") has a row a repetition;
- each option and each parameter of a problem is a column, "options.k", "parameters.mass": float64 where all its values are
  numbers, else a category of their JSON text without quotes ("true", "implicit", "[0.0,150.0,-4.61538]").

Units: [s] of "step_size", "t_0", "t_end", "failure.time" and "agreement_time", [ns] of "time.*" but "time.spread"; [m] and [rad]
of "errors.q.*_absolute", [m/s] and [rad/s] of those of v, [N] of those of lambda, none of "errors.*.end_relative"; [J] of
"drift.energy", [kg m^2/s] of "drift.angular_momentum", [m] of "drift.position_constraint", [m/s] of "drift.velocity_constraint";
SI of "parameters.*". Costs are counts of a whole run.
"""

from __future__ import annotations

import json
import math
import os
import warnings
from collections.abc import Callable, Iterator
from datetime import datetime
from typing import Any, Final, Literal

import pandas as pd  # type: ignore[import]

__all__ = ["COLUMNS", "SCHEMA", "RecordError", "curve_names", "errors_of", "read_records"]

SCHEMA: Final = 1
"""The version of the format that is read."""

Kind = Literal["number", "integer", "word", "text", "flag", "date", "numbers"]


def _columns() -> dict[str, Kind]:
    kinds: dict[str, Kind] = {"key": "text"}

    def add(kind: Kind, prefix: str, names: str) -> None:
        kinds.update((prefix + name, kind) for name in names.split())

    add("word", "", "study problem formulation integrator start precision")
    add("number", "", "step_size requested_step_size")
    add("integer", "", "steps")
    add("number", "", "t_0 t_end local_steps")
    add("word", "", "outcome")
    add("number", "failure.", "time step residual")
    add("text", "failure.", "message")
    for quantity in ("q", "v", "lambda"):
        add("number", f"errors.{quantity}.", "end_relative end_absolute max_absolute")
    add("number", "", "agreement_time")
    add("number", "drift.", "energy angular_momentum position_constraint velocity_constraint group")
    add("word", "", "solver")
    add("number", "cost.", "residuals jacobians factorizations")
    add("number", "cost.factorizations_by_cause.", "start first refresh slow_convergence")
    add("number", "cost.", "solves rejected_steps newton_iterations exp log tangent tangent_inverse commutators flops")
    add("number", "cost.flops_by_kind.", "add multiply divide square_root transcendental")
    add("number", "time.ns_per_step.", "median min max repetitions")
    add("numbers", "time.ns_per_step.", "samples")
    add("number", "time.", "start_ns total_ns spread")
    add("flag", "time.", "unsteady")
    add("word", "reference.", "method")
    add("number", "reference.", "error_estimate")
    add("word", "provenance.", "commit compiler flags cpu")
    add("flag", "provenance.", "dirty")
    add("date", "provenance.", "date")
    return kinds


COLUMNS: Final[dict[str, Kind]] = _columns()
"""The columns that every table has, and the kind of their values. Options, parameters and libraries come behind them, as the
records have them; so does a key that a later version of liebench has added."""

_REQUIRED: Final = (
    "key study problem formulation integrator start precision step_size steps t_0 t_end outcome reference.error_estimate"
).split()
_OBJECTS: Final = ("parameters", "options", "reference", "cost")
_DATE: Final = "%Y-%m-%dT%H:%M:%SZ"


class RecordError(ValueError):
    """A line that is not a record; the message begins with its place, "study.jsonl:12"."""


def read_records(*files: str | os.PathLike[str], skip_bad_lines: bool = False) -> pd.DataFrame:
    """The records of all files, one row a run, in the order of their lines; the columns are described above.

    Of lines with the same key the last one counts, in the place of the first: a timed row replaces the untimed one. A line that is
    not a record raises RecordError; with `skip_bad_lines` each is a warning, and the others are read.
    """
    rows: dict[str, dict[str, Any]] = {}
    for file in files:
        with open(file, "rb") as stream:
            for number, line in enumerate(stream, start=1):
                if not line.rstrip(b"\r\n"):
                    continue
                try:
                    row = _row_of(line)
                except ValueError as fault:
                    error = RecordError(f"{os.fspath(file)}:{number}: {fault}")
                    if not skip_bad_lines:
                        raise error from None
                    warnings.warn(str(error), stacklevel=2)
                else:
                    rows[row["key"]] = row
    return _table(list(rows.values()))


def errors_of(runs: pd.DataFrame) -> pd.DataFrame:
    """One row for each error of each run of a table of `read_records`: key, quantity ("q", "v" or "lambda"), norm and error.

    Errors that a run does not have are left out. `errors_of(runs).merge(runs, on="key")` has what belongs to the run beside them.
    """
    names = [name.split(".") for name in COLUMNS if name.startswith("errors.")]
    parts = [
        pd.DataFrame({"key": runs["key"], "quantity": quantity, "norm": norm, "error": runs[f"errors.{quantity}.{norm}"]})
        for _, quantity, norm in names
    ]
    table = pd.concat(parts).dropna(subset=["error"]).reset_index(drop=True)
    return table.astype({"quantity": "category", "norm": "category"})


def curve_names(runs: pd.DataFrame) -> pd.Series:
    """To which curve each run belongs, by the names of `liebench table`: what has several values among the curves of this table
    and, where that does not tell all apart, what some curves have and others have not. Options come in one order for all
    methods, the program has them in the order of each method.

    The runs of a curve differ in the step size alone, or in the tolerance of a method that chooses its steps. A column that the
    table lacks tells no curves apart: without "formulation" the curves of a method have one name in all formulations.
    """
    # Runs over so many steps end elsewhere for every step size.
    table = runs.assign(t_end=runs["t_end"].where(runs["local_steps"].isna()))
    several = {part: [name for name in table if name.startswith(part + ".")] for part in ("parameters", "options")}
    order = ["problem", "formulation", *several["parameters"], "integrator", *several["options"]]
    order += ["start", "precision", "t_0", "t_end", "local_steps"]
    identity = table[[name for name in order if name in table and name != "options.tolerance"]]
    texts = pd.DataFrame({name: column.map(_label(name)) for name, column in identity.items()}, dtype="object")
    named = {name for name, column in texts.items() if column.nunique() > 1 and name != "parameters.content"}
    names = _joined(texts, named)
    if names.nunique() < len(texts.drop_duplicates()):
        # The hash of a scene's content tells those apart only whose names do not.
        named |= {name for name, column in texts.items() if column.nunique(dropna=False) > 1}
        names = _joined(texts, named)
    names = names.where(names != "", runs["integrator"].astype("object"))
    return names.astype(pd.CategoricalDtype(names.unique()))


def _label(column: str) -> Callable[[object], object]:
    speaks_for_itself = column in ("problem", "formulation", "integrator", "precision")
    before = "" if speaks_for_itself else column.rpartition(".")[2] + " = "
    # As JSON has them; an option is an integer as often as not, which pandas makes a float where some runs lack it.
    is_time = column in ("t_0", "t_end")

    def label(value: object) -> object:
        if isinstance(value, float):
            if math.isnan(value):
                return math.nan
            return f"{before}{float(value)!r}" if is_time else f"{before}{value:.12g}"
        return f"{before}{value}"

    return label


def _joined(texts: pd.DataFrame, named: set[str]) -> pd.Series:
    rows = texts[[name for name in texts if name in named]].to_numpy()
    names = [", ".join(text for text in row if isinstance(text, str)) for row in rows]
    return pd.Series(names, texts.index, dtype="object")


def _row_of(line: bytes) -> dict[str, Any]:
    record = json.loads(line, parse_constant=_no_number)
    if not isinstance(record, dict):
        raise ValueError(f"{_json(record)} is not allowed here; allowed: a record, which is a JSON object")
    if record.get("schema") != SCHEMA:
        raise ValueError(f"schema: {_json(record.get('schema'))} is not allowed here; allowed: {SCHEMA}")
    for name in _OBJECTS:
        if not isinstance(record.get(name), dict):
            raise ValueError(f"{name}: {_json(record.get(name))} is not allowed here; allowed: an object")
    del record["schema"]
    row = dict(_flat("", record))
    wanted = list(_REQUIRED)
    if row.get("outcome") != "ok":
        wanted += ["failure.time", "failure.message"]
    elif "agreement_time" not in row:
        wanted += ["errors.q.end_relative", "errors.v.end_relative"]
    for name in wanted:
        if name not in row:
            raise ValueError(f"{name} is missing")
    return row


def _flat(prefix: str, value: dict[str, Any]) -> Iterator[tuple[str, Any]]:
    for name, part in value.items():
        path = prefix + name
        kind = COLUMNS.get(path)
        if kind is not None:
            if not _ALLOWED[kind][1](part):
                raise ValueError(f"{path}: {_json(part)} is not allowed here; allowed: {_ALLOWED[kind][0]}")
            yield path, part
        elif isinstance(part, dict):
            # The empty object of a run without options has no columns.
            yield from _flat(path + ".", part)
        else:
            yield path, part


def _is_number(value: object) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _is_text(value: object) -> bool:
    return isinstance(value, str)


def _is_date(value: object) -> bool:
    try:
        return isinstance(value, str) and bool(datetime.strptime(value, _DATE))
    except ValueError:
        return False


_ALLOWED: Final[dict[Kind, tuple[str, Callable[[object], bool]]]] = {
    "number": ("a finite number", _is_number),
    "integer": ("an integer", lambda value: isinstance(value, int) and not isinstance(value, bool)),
    "word": ("a text", _is_text),
    "text": ("a text", _is_text),
    "flag": ("true or false", lambda value: isinstance(value, bool)),
    "date": ("a time in UTC like 2026-01-31T12:00:00Z", _is_date),
    "numbers": ("a list of numbers", lambda value: isinstance(value, list) and all(map(_is_number, value))),
}


def _table(rows: list[dict[str, Any]]) -> pd.DataFrame:
    # In the order in which records come with them.
    more = dict.fromkeys(name for row in rows for name in row if name not in COLUMNS)
    columns = {name: _known_column(kind, [row.get(name) for row in rows]) for name, kind in COLUMNS.items()}
    columns |= {name: _other_column([row.get(name) for row in rows]) for name in more}
    return pd.DataFrame(columns)


def _known_column(kind: Kind, values: list[Any]) -> pd.Series:
    if kind == "number":
        return pd.Series(values, dtype="float64")
    if kind == "integer":
        return pd.Series(values, dtype="int64")
    if kind == "word":
        return pd.Series(pd.Categorical(values))
    if kind == "flag":
        return pd.Series([value is True for value in values], dtype="bool")
    if kind == "date":
        return pd.Series(pd.to_datetime(values, format=_DATE, utc=True))
    return pd.Series([math.nan if value is None else value for value in values], dtype="object")


def _other_column(values: list[Any]) -> pd.Series:
    if all(value is None or _is_number(value) for value in values):
        return pd.Series(values, dtype="float64")
    texts = [value if value is None or isinstance(value, str) else _json(value) for value in values]
    return pd.Series(pd.Categorical(texts))


def _json(value: object) -> str:
    return json.dumps(value, separators=(",", ":"))


def _no_number(word: str) -> None:
    raise ValueError(f"{word} is no number of JSON")
