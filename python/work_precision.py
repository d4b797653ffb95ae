"""The work-precision diagram of results/cost_accuracy.jsonl: what an error of q costs in computing time.

    python3 python/work_precision.py [RECORDS.jsonl [PICTURE]]

Cells begin with "# %%", so that editors run it as a notebook. Needed are pandas and matplotlib.
"""

# %% What is read and written
from __future__ import annotations

import sys

import matplotlib.pyplot as plt  # type: ignore[import]
from liebench_records import curve_names, read_records

given = dict(enumerate(sys.argv))
records = given.get(1, "results/cost_accuracy.jsonl")
picture = given.get(2, "work_precision.svg")

# %% One row a run; of runs in double, in which alone there are times
runs = read_records(records)
runs = runs[runs["precision"] == "double"]
print(runs.groupby(["integrator", "outcome"], observed=True).size().unstack(fill_value=0))

# %% The panels: without constraints, and the two forms of the constrained equations
free, constrained = (runs[runs["formulation"] == name] for name in ("SO3", "R3xSO3"))
panels = {
    "Unconstrained, SO(3)": free,
    "Index 3, R^3 x SO(3)": constrained[constrained["options.form"] == "index3"],
    "Stabilized index 2, R^3 x SO(3)": constrained[constrained["options.form"] == "stabilized_index2"],
}

# %% A method has one colour and mark in all panels. Failed runs have no error: their step sizes are named below.
methods = curve_names(runs.drop(columns=["formulation", "options.form", "options.modified_start"]))
style = {
    name: {"color": f"C{number % 10}", "marker": "o^sDv<>pX*"[number % 10], "linestyle": "--" if number >= 10 else "-"}
    for number, name in enumerate(methods.cat.categories)
}
figure, axes = plt.subplots(1, len(panels), figsize=(13, 6), sharex=True, sharey=True)
for axis, (title, panel) in zip(axes, panels.items()):
    for name, curve in panel.groupby(methods, observed=True):
        curve = curve.sort_values("step_size")
        seconds, error = 1e-9 * curve["time.total_ns"], curve["errors.q.end_relative"]
        axis.loglog(seconds, error, label=name, markersize=4, **style[name])
    axis.set(title=title, xlabel="computing time of the run in s")
    axis.grid(color="0.9")
axes[0].set_ylabel("relative error of q at the end")
handles = {label: handle for axis in axes for handle, label in zip(*axis.get_legend_handles_labels())}
figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=3, frameon=False, fontsize="small")
figure.tight_layout(rect=(0, 0.2, 1, 1))
figure.savefig(picture)

# %% Which runs failed, and how
failed = runs[runs["outcome"] != "ok"]
shown = ["formulation", "integrator", "options.k", "options.form", "step_size", "outcome", "failure.time"]
print(failed[shown].to_string(index=False))

# %% The fastest run of each formulation with an error of at most 1e-6; docs/cost_accuracy.md interpolates between runs
good = runs[runs["errors.q.end_relative"] <= 1e-6].assign(method=methods)
fastest = good.loc[good.groupby("formulation", observed=True)["time.total_ns"].idxmin()]
shown = ["formulation", "options.form", "method", "step_size", "errors.q.end_relative", "time.total_ns"]
print(fastest[shown].to_string(index=False))
