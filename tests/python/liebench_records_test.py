"""The loader of records against the tables that the program makes of the same files, and against the format.

Environment: LIEBENCH_PROGRAM, the program built. Ends with status 77 where there is no pandas.
"""

import importlib.util
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
import warnings
from pathlib import Path

try:
    import pandas as pd
except ImportError:
    print(f"skipped: {sys.executable} has no pandas (Debian package python3-pandas)")
    sys.exit(77)

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP / "python"))
from liebench_records import COLUMNS, RecordError, curve_names, errors_of, read_records  # noqa: E402

COST_ACCURACY = TOP / "results/cost_accuracy.jsonl"


def table(*arguments):
    """A table of the program, as CSV."""
    command = [os.environ["LIEBENCH_PROGRAM"], "table", *map(str, arguments), "--format", "csv"]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return pd.read_csv(io.StringIO(text), float_precision="round_trip")


def parts(name):
    """A curve's name without the order of its parts, which is the loader's own."""
    return ", ".join(sorted(name.split(", ")))


def without(record, key):
    return {name: value for name, value in record.items() if name != key}


def schema_leaves(schema, definitions, path=""):
    if "$ref" in schema:
        schema = definitions[schema["$ref"].rpartition("/")[2]]
    for name, part in schema.get("properties", {}).items():
        if part.get("type") == "object" or "$ref" in part:
            yield from schema_leaves(part, definitions, f"{path}{name}.")
        else:
            yield path + name


class AgainstTheProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.runs = read_records(COST_ACCURACY)
        cls.runs["curve"] = curve_names(cls.runs).astype("str").map(parts)

    def joined(self, theirs, on):
        """Rows of the program's table, which has a curve for each of them, beside the runs."""
        theirs = theirs.assign(curve=theirs["curve"].map(parts))
        both = theirs.merge(self.runs, left_on=["curve", *on], right_on=["curve", *on.values()], validate="one_to_one")
        self.assertEqual(len(both), len(theirs))
        return both

    def test_costs_and_times_of_a_step(self):
        theirs = table(COST_ACCURACY, "--kind", "costs", "--step-size", "5e-4")
        self.assertGreater(len(theirs), 100)
        both = self.joined(theirs.rename(columns={"steps": "steps in all"}), {"h [s]": "step_size"})
        names = {
            "residuals": "residuals",
            "Jacobians": "jacobians",
            "factorizations": "factorizations",
            "at the start": "factorizations_by_cause.start",
            "first": "factorizations_by_cause.first",
            "refresh": "factorizations_by_cause.refresh",
            "slow convergence": "factorizations_by_cause.slow_convergence",
            "solves": "solves",
            "Newton iterations": "newton_iterations",
            "exp": "exp",
            "log": "log",
            "T": "tangent",
            "T^-1": "tangent_inverse",
            "commutators": "commutators",
            "flops": "flops",
            "add": "flops_by_kind.add",
            "multiply": "flops_by_kind.multiply",
            "divide": "flops_by_kind.divide",
            "square root": "flops_by_kind.square_root",
            "transcendental": "flops_by_kind.transcendental",
        }
        self.assertEqual(set(names), set(theirs.columns) - {"curve", "h [s]", "steps", "time [ns]"})
        for column, name in names.items():
            # The program writes all digits of the quotient.
            pd.testing.assert_series_equal(
                both[column].astype("float64"), both[f"cost.{name}"] / both["steps"], rtol=1e-14, check_names=False
            )
        pd.testing.assert_series_equal(both["steps in all"], both["steps"], check_names=False)
        pd.testing.assert_series_equal(both["time [ns]"], both["time.ns_per_step.median"], check_names=False)

    def test_drift(self):
        theirs = table(COST_ACCURACY, "--kind", "invariants")
        self.assertEqual(len(theirs), (self.runs["outcome"] == "ok").sum())
        both = self.joined(theirs, {"h [s]": "step_size"})
        for column in set(theirs.columns) - {"curve", "h [s]"}:
            name = "drift." + column.partition(" [")[0].replace(" ", "_")
            pd.testing.assert_series_equal(both[column], both[name], check_names=False, check_exact=True)

    def test_errors(self):
        """The target that is the error of a run is reached by that run."""
        constrained = self.runs[self.runs["errors.lambda.end_relative"].notna()]
        run = constrained[(constrained["step_size"] == 5e-4) & (constrained["options.k"] == 3)].iloc[0]
        for quantity in ("q", "v", "lambda"):
            for norm in ("end_relative", "end_absolute", "max_absolute"):
                with self.subTest(quantity=quantity, norm=norm):
                    target = repr(float(run[f"errors.{quantity}.{norm}"]))
                    theirs = table(COST_ACCURACY, "--kind", "cost-accuracy", "--y", quantity, "--norm", norm, "--target", target)
                    row = theirs[theirs["curve"].map(parts) == run["curve"]].squeeze()
                    self.assertAlmostEqual(row["h [s]"] / run["step_size"], 1, delta=1e-12)
                    self.assertAlmostEqual(row["flops"] / run["cost.flops"], 1, delta=1e-12)

    def test_outcomes_of_the_curves_of_every_file(self):
        names = {"first failure at t [s]": "failure.time", "step": "failure.step", "residual": "failure.residual"}
        for file in sorted((TOP / "results").glob("*.jsonl")):
            with self.subTest(file=file.name):
                runs = read_records(file)
                place = ["curve", "outcome"]
                runs = runs.assign(curve=curve_names(runs).astype("str").map(parts), outcome=runs["outcome"].astype("str"))
                coarsest = runs.sort_values("step_size", ascending=False).drop_duplicates(place).set_index(place)
                theirs = table(file, "--kind", "outcomes")
                theirs = theirs.assign(curve=theirs["curve"].map(parts)).set_index(place)
                self.assertEqual(set(coarsest.index), set(theirs.index))
                theirs = theirs.loc[coarsest.index]
                self.assertEqual(theirs["runs"].to_dict(), runs.groupby(place).size().to_dict())
                for column, name in names.items():
                    pd.testing.assert_series_equal(
                        coarsest[name], theirs[column].astype("float64"), check_names=False, check_exact=True
                    )


class Format(unittest.TestCase):
    def test_columns_are_the_leaves_of_the_schema(self):
        schema = json.loads((TOP / "harness/record.schema.json").read_text())
        leaves = set(schema_leaves(schema, schema["definitions"])) - {"schema"}
        # These are what the records have.
        open_ended = {name for name in leaves if name in ("parameters", "options", "provenance.libraries")}
        self.assertEqual(set(COLUMNS), leaves - open_ended)

    def test_what_a_record_lacks_is_nan(self):
        runs = read_records(COST_ACCURACY)
        failed = runs[runs["outcome"] != "ok"]
        self.assertGreater(len(failed), 0)
        self.assertTrue(failed.filter(regex=r"^(errors|drift)\.").isna().all(axis=None))
        self.assertTrue(failed["failure.message"].notna().all())
        free = runs[runs["formulation"].isin(["SO3", "S3"])]
        self.assertTrue(free.filter(regex=r"^errors\.lambda\.|constraint$|^options.form$").isna().all(axis=None))
        self.assertTrue((free["outcome"] == "ok").all() and free["errors.q.end_relative"].notna().all())

    def test_types_do_not_depend_on_the_file(self):
        empty, full = read_records(), read_records(COST_ACCURACY)
        for name, kind in COLUMNS.items():
            self.assertEqual(empty[name].dtype.kind, full[name].dtype.kind, name)
        self.assertEqual(list(full["options.correction"].cat.categories), ["implicit", "true"])
        self.assertEqual(full["options.k"].dtype, "float64")
        self.assertEqual(str(full["provenance.date"].dt.tz), "UTC")
        samples = full.explode("time.ns_per_step.samples")
        self.assertEqual(samples["time.ns_per_step.samples"].count(), full["time.ns_per_step.repetitions"].sum())

    def test_errors_in_rows(self):
        runs = read_records(COST_ACCURACY)
        errors = errors_of(runs)
        self.assertEqual(len(errors), runs.filter(like="errors.").count().sum())
        beside = errors.merge(runs, on="key", validate="many_to_one")
        largest = beside[(beside["quantity"] == "lambda") & (beside["norm"] == "max_absolute")]
        self.assertTrue((largest["error"] == largest["errors.lambda.max_absolute"]).all())


class Lines(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "runs.jsonl"
        with open(COST_ACCURACY) as stream:
            self.records = [json.loads(next(stream)) for _ in range(3)]

    def write(self, *lines):
        self.file.write_text("".join(line if isinstance(line, str) else json.dumps(line) + "\n" for line in lines))

    def test_the_last_row_of_a_key_counts_in_the_place_of_the_first(self):
        first, second, third = self.records
        self.write(without(first, "time"), second, first, "\n", third)
        runs = read_records(self.file, self.file)
        self.assertEqual(list(runs["key"]), [record["key"] for record in self.records])
        self.assertEqual(runs["time.total_ns"][0], first["time"]["total_ns"])

    def test_a_key_of_a_later_version_is_a_column(self):
        self.write(self.records[0] | {"weather": {"wind": 3, "sky": "blue"}}, self.records[1])
        runs = read_records(self.file)
        self.assertEqual(runs["weather.wind"][0], 3)
        self.assertEqual(runs["weather.sky"][0], "blue")
        self.assertTrue(runs.loc[1, ["weather.wind", "weather.sky"]].isna().all())

    def test_a_bad_line_is_named(self):
        good = self.records[0]
        cases = {
            '{"schema": 1, "key"\n': "Expecting",
            "[1]\n": "allowed: a record",
            json.dumps(good).replace('"steps": 1000', '"steps": NaN') + "\n": "NaN is no number",
            json.dumps(good | {"steps": "many"}) + "\n": 'steps: "many" is not allowed here; allowed: an integer',
            json.dumps(good | {"schema": 2}) + "\n": "schema: 2 is not allowed here; allowed: 1",
            json.dumps(good | {"step_size": True}) + "\n": "step_size: true is not allowed here",
            json.dumps(good | {"t_end": 1e300}).replace("1e+300", "1e999") + "\n": "t_end: Infinity is not allowed here",
            json.dumps(good | {"cost": 3}) + "\n": "cost: 3 is not allowed here; allowed: an object",
            json.dumps(good | {"outcome": "step_limit"}) + "\n": "failure.time is missing",
            json.dumps(without(good, "errors")) + "\n": "errors.q.end_relative is missing",
            json.dumps(without(good, "key")) + "\n": "key is missing",
            "\udcff\n".encode("utf-8", "surrogateescape").decode("latin-1"): "Expecting",
        }
        for line, message in cases.items():
            with self.subTest(message=message):
                self.write(self.records[1], line, self.records[2])
                with self.assertRaises(RecordError) as caught:
                    read_records(self.file)
                self.assertTrue(str(caught.exception).startswith(f"{self.file}:2: "), caught.exception)
                self.assertIn(message, str(caught.exception))
                with warnings.catch_warnings(record=True) as said:
                    warnings.simplefilter("always")
                    runs = read_records(self.file, skip_bad_lines=True)
                self.assertEqual(list(runs["key"]), [record["key"] for record in self.records[1:]])
                self.assertEqual([str(warning.message) for warning in said], [str(caught.exception)])


class Example(unittest.TestCase):
    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "python3-matplotlib is not here")
    def test_the_example_draws_its_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [sys.executable, TOP / "python/work_precision.py", COST_ACCURACY, "picture.svg"]
            environment = os.environ | {"MPLBACKEND": "agg", "MPLCONFIGDIR": folder}
            done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertIn("bliedf2nd, k = 6", done.stdout)
            self.assertIn("</svg>", (Path(folder) / "picture.svg").read_text())


if __name__ == "__main__":
    unittest.main()
