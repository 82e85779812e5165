#!/usr/bin/env python3
"""Writes the table of docs/gltf.md: what `trueshade info` says of each file of the glTF-Validator's corpus.

Usage: gltf_corpus_table.py COMMAND CORPUS [--files]
CORPUS holds EXPECTED.csv (file, errors, warnings, their codes) and the files it names. --files prints one line a file.
"""
import collections
import csv
import pathlib
import re
import subprocess
import sys

# Codes of errors after which a file says nothing certain: its container, syntax, schema, references or sizes are broken.
STRUCTURAL = re.compile(
    "GLB_|INVALID_JSON|INVALID_URI|IO_ERROR|UNDEFINED_PROPERTY|TYPE_MISMATCH|ARRAY_|UNRESOLVED_|TOO_LONG|_LOOP|"
    "PARENT_OVERRIDE|OUT_OF_RANGE|INDEX_OOB|ONE_OF_MISMATCH|PATTERN_MISMATCH|VALUE_NOT_IN_RANGE|INVALID_FORMAT|"
    "MAJOR_VERSION|BYTE_LENGTH_MISMATCH|MISSING_GLB_DATA"
)


def outcome(command, path):
    """(exit code, first line of the error) of the command."""
    run = subprocess.run([command, "info", str(path)], capture_output=True, timeout=10, check=False)
    text = run.stderr.decode("utf-8", "replace").strip().split("\n")[-1]
    return run.returncode, text.replace(str(path), path.name)


def main():
    command, corpus = sys.argv[1], pathlib.Path(sys.argv[2])
    kinds = collections.defaultdict(collections.Counter)
    accepted = collections.Counter()
    refused_valid, unclean = [], []
    with open(corpus / "EXPECTED.csv", encoding="utf-8") as table:
        for row in csv.DictReader(table):
            code, text = outcome(command, corpus / row["file"])
            kind = "errors" if int(row["numErrors"]) else "warnings alone" if int(row["numWarnings"]) else "clean"
            if kind == "errors" and STRUCTURAL.search(row["errorCodes"]):
                kind = "errors of structure"
            verdict = "loaded" if code == 0 else "refused" if code in (3, 4, 5) else "unclean"
            kinds[kind][verdict] += 1
            if verdict == "unclean":
                unclean.append((row["file"], code, text))
            if verdict == "loaded" and kind.startswith("errors"):
                accepted.update({row["errorCodes"]: 1})
            if verdict == "refused" and not kind.startswith("errors"):
                refused_valid.append((row["file"], text))
            if "--files" in sys.argv:
                print(f"{verdict:8} {kind:20} {row['file']} [{row['errorCodes']}] {text}")
    print("| the validator finds | files | loaded | refused | neither |\n|---|---|---|---|---|")
    for kind in ("clean", "warnings alone", "errors", "errors of structure"):
        n = kinds[kind]
        print(f"| {kind} | {sum(n.values())} | {n['loaded']} | {n['refused']} | {n['unclean']} |")
    print("\nLoaded in spite of errors:\n\n| files | codes |\n|---|---|")
    for codes, count in sorted(accepted.items()):
        print(f"| {count} | {codes.replace('|', ', ')} |")
    print("\nRefused without errors of the validator:\n\n| file | why |\n|---|---|")
    for file, text in refused_valid:
        print(f"| {file} | {text.removeprefix('trueshade: error: ')} |")
    for entry in unclean:
        print("UNCLEAN", *entry)
    return 1 if unclean else 0


if __name__ == "__main__":
    sys.exit(main())
