#!/usr/bin/env python3
"""Markdown tables from Google Benchmark's JSON: one table a benchmark, medians of its repetitions.

    table.py RESULTS.json
"""
import json
import platform
import re
import sys
from pathlib import Path

# What Google Benchmark writes beside the counters.
OWN_KEYS = {"name", "family_index", "per_family_instance_index", "run_name", "run_type", "repetitions",
            "repetition_index", "threads", "aggregate_name", "aggregate_unit", "iterations", "real_time",
            "cpu_time", "time_unit"}


def processor():
    info = Path("/proc/cpuinfo").read_text() if Path("/proc/cpuinfo").exists() else ""
    model = re.search(r"model name\s*: (.*)", info)
    flags = re.search(r"flags\s*: (.*)", info)
    best = [s for s in ("avx512f", "avx2", "sse2") if flags and s in flags[1].split()]
    return f"{model[1] if model else platform.machine()}, {best[0] if best else 'instruction set unknown'}"


def significant(value):
    if value >= 1e6:
        return f"{value:.3g}"
    return f"{value:,.0f}" if value >= 1000 else f"{value:.3g}"


def shown(counter, value):
    """Column title and text: seconds for each in ns, bytes a second in GB/s."""
    if re.search(r"(^|_)s_per_", counter):
        return re.sub(r"(^|_)s_per_", r"\1ns_per_", counter).replace("_", " "), significant(value * 1e9)
    if counter == "bytes_per_s":
        return "GB/s", significant(value / 1e9)
    return counter.replace("_", " "), significant(value)


def row(benchmark):
    parts = benchmark["run_name"].split("/")
    family = "/".join(p for p in parts if ":" not in p and p != "manual_time")
    cells = {}
    for part in parts:
        key, _, number = part.partition(":")
        if key in ("bodies", "threads"):
            cells[key] = f"{int(number):,}"
    cells["ms"] = significant(benchmark["real_time"])
    cells.update(shown(k, v) for k, v in benchmark.items() if k not in OWN_KEYS)
    return family, cells


def main(path):
    results = json.loads(Path(path).read_text())
    context = results["context"]
    print(f"{context['num_cpus']} processors ({processor()}), load {context['load_avg'][0]:.1f} at the start.")
    previous = None
    for benchmark in results["benchmarks"]:
        if benchmark.get("aggregate_name", "median") != "median":
            continue
        family, cells = row(benchmark)
        if family != previous:
            print(f"\n### {family}\n\n| {' | '.join(cells)} |\n|{' ---: |' * len(cells)}")
        print(f"| {' | '.join(cells.values())} |")
        previous = family


if __name__ == "__main__":
    main(sys.argv[1])
