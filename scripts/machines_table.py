#!/usr/bin/env python3
"""Writes docs/data/machines.md from the results of `trueshade bench --standard --json FILE` in docs/data/machines.

Usage: machines_table.py FOLDER [--check]
FOLDER is docs/data. --check writes nothing, and ends with status 1 where the page is not what its files say.
"""
import json
import pathlib
import statistics
import sys
import textwrap

HEAD = """# Machines, and their scores

<!-- Written by scripts/machines_table.py from the files in docs/data/machines: add a file and run it. -->
Scores of `trueshade bench --standard`, each from the file of JSON that is named, and how busy the machine was. A score
is frames a second, as standard 2 of [performance.md](../performance.md) has it, of files of standard 1 too. A row in
brackets is not to be quoted, for the reasons below.
"""
TARGETS = ["avx512", "avx2", "sse4", "scalar"]
STANDARD = 2


def scores_of(name, run):
    """By SIMD target: the mean that standard 2 has, of the files' least times, which those of standard 1 have too."""
    rows = {run["simd"]: run["scenes"]}
    for i, peer in enumerate(run["scenes"][0]["peers"]):
        rows[peer["strategy"].removeprefix("simd=")] = [scene["peers"][i] for scene in run["scenes"]]
    scores = {simd: statistics.geometric_mean(1000 / row["least_ms"] for row in of) for simd, of in rows.items()}
    if run["standard"]["version"] == STANDARD:  # the command has another hand's mean
        for target in run["standard"]["targets"]:
            if abs(target["score"] / scores[target["simd"]] - 1) > 1e-6:
                sys.exit(f"{name}: its score on {target['simd']} is not the mean of its rows")
    return scores


def others(load):
    """How many cores others used, or the host took."""
    return f"{load['others'] + load['stolen']:.2f}" if load["is_known"] else "not known"


def row(name, run):
    machine, scores = run["machine"], scores_of(name, run)
    shown = "({:.1f})" if run["not_to_be_quoted"] else "{:.1f}"
    cells = [
        f"[{name}](machines/{name}.json)",
        f"{machine['cpu']}, {machine['clock_ghz']:.2f} GHz",
        f"{machine['cores']}, {run['threads']}",
        shown.format(scores[run["simd"]]),
        *(shown.format(scores[target]) if target in scores else "" for target in TARGETS),
        f"{others(machine['load_before'])}, {max(others(scene['load']) for scene in run['scenes'])}",
        f"{run['commit']}, {machine['date'][:10]}",
    ]
    return "| " + " | ".join(cells) + " |"


def about(name, run):
    m = run["machine"]
    caches = ", ".join(
        f"L{c['level']} {c['type'].lower()} {c['kib']} KiB" + (f" x {c['count']}" if c["count"] > 1 else "")
        for c in m["caches"]
    )
    place = f"a guest of {m['hypervisor'] or 'a hypervisor'}" if m["virtual"] else "not virtual"
    numbers = " ".join(f"{key} {m[key]}" for key in ("family", "model", "stepping") if key in m)
    text = (
        f"**{name}**: {m['vendor']} {numbers}, {m['physical_cores']} cores with {m['hardware_threads']} threads, {caches},"
        f" {m['memory_mib'] / 1024:.0f} GiB, {place}; {m['os']}, {m['kernel']}, {m['compiler']}, {m['c_library']}."
    )
    reasons = run["not_to_be_quoted"]
    if reasons:
        more = f", and by {len(reasons) - 1} more reasons in its file" if len(reasons) > 1 else ""
        text += f" Not to be quoted: {reasons[0]}{more}."
    return textwrap.fill(text, 120, break_long_words=False, break_on_hyphens=False) + "\n"


def page(folder):
    runs = []
    for file in sorted((folder / "machines").glob("*.json")):
        run = json.loads(file.read_text(encoding="utf-8"))
        if "standard" not in run or run["quick"]:
            sys.exit(f"{file}: this is no result of `trueshade bench --standard --json FILE` without --quick")
        runs.append((file.stem, run))
    runs.sort(key=lambda named: -scores_of(*named)[named[1]["simd"]])
    columns = ["file", "CPU", "cores, threads", "score", *TARGETS, "cores used by others: before, most during"]
    lines = ["| " + " | ".join([*columns, "commit, date"]) + " |", "|---" * (len(columns) + 1) + "|"]
    lines += [row(*named) for named in runs]
    return HEAD + "\n" + "\n".join(lines) + "\n\n" + "\n".join(about(*named) for named in runs)


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    target = folder / "machines.md"
    text = page(folder)
    if "--check" not in sys.argv:
        target.write_text(text, encoding="utf-8")
    elif target.read_text(encoding="utf-8") != text:
        sys.exit(f"{target} is not what its files say: run scripts/machines_table.py {sys.argv[1]}")


if __name__ == "__main__":
    main()
