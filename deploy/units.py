#!/usr/bin/env python3
"""Checks the files of a build folder, several at once: units.py FOLDER REGEX (tidy | gcc).

Takes the entries of FOLDER/compile_commands.json whose path the regular expression finds, and runs clang-tidy over each
file (tidy), or its compiler without code generation (gcc), for errors and warnings alone. A file that was good is not
checked again until its preprocessed text, with its comments, or .clang-tidy changes, except if CI is true. Prints what
the failed files say, and exits with 1 if there are any.
"""
import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

# clang-tidy gets the commands of gcc. -Wno-shadow: a local may have the name of something in another file of its unit.
# HWY_COMPILE_ONLY_STATIC: of kernels it checks one instruction set; the text for the others is the same.
FOR_CLANG = ["-Wno-unknown-warning-option", "-Wno-shadow", "-DHWY_COMPILE_ONLY_STATIC"]


def options_of(entry):
    """The compiler and its options, without the output and the dependency file."""
    words = shlex.split(entry["command"])
    words = words[next(i for i, word in enumerate(words) if word.endswith("++")) :]
    options, skip = [], False
    for word in words:
        if not skip and word not in ("-o", "-MT", "-MF", "-MD", "-c", entry["file"]):
            options.append(word)
        skip = word in ("-o", "-MT", "-MF")
    return options


def command_of(entry, folder, tool):
    if tool == "tidy":
        return ["clang-tidy", "-p", folder, "-quiet", *(f"-extra-arg={option}" for option in FOR_CLANG), entry["file"]]
    return [*options_of(entry), "-fsyntax-only", entry["file"]]


def text_of(entry, tool):
    """What the result depends on, or nothing if the file cannot be preprocessed."""
    options = options_of(entry)
    compiler = ["clang++", *options[1:], *FOR_CLANG] if tool == "tidy" else options
    made = subprocess.run([*compiler, "-E", "-C", entry["file"]], cwd=entry["directory"], capture_output=True)
    return made.stdout if made.returncode == 0 else b""


def fault_of(entry, folder, tool):
    """What the tool says about a file, or nothing if the file is good."""
    command = command_of(entry, folder, tool)
    key = hashlib.sha256(" ".join(command).encode() + pathlib.Path(".clang-tidy").read_bytes())
    text = b"" if os.environ.get("CI") == "true" else text_of(entry, tool)
    key.update(text)
    stamp = pathlib.Path(folder, "good", key.hexdigest())
    if text and stamp.exists():
        return ""
    ran = subprocess.run(command, cwd=entry["directory"], capture_output=True, text=True)
    if ran.returncode != 0:
        return ran.stdout + ran.stderr
    if text:
        stamp.parent.mkdir(exist_ok=True)
        stamp.touch()
    return ""


def size_of(entry):
    """The bytes of a file, and of those that it includes if it is of a unity build."""
    text = pathlib.Path(entry["file"]).read_text()
    return len(text) + sum(os.path.getsize(path) for path in re.findall(r'^#include "(/.*)"', text, re.MULTILINE))


def main(folder, pattern, tool):
    os.chdir(pathlib.Path(__file__).resolve().parent.parent)
    folder = os.path.abspath(folder)
    entries = json.loads(pathlib.Path(folder, "compile_commands.json").read_text())
    entries = [entry for entry in entries if re.search(pattern, entry["file"])]
    if not entries:
        sys.exit(f"units.py: no file of {folder} fits {pattern}.")
    # Large files first, so that none is left over at the end.
    entries.sort(key=size_of, reverse=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        faults = [fault for fault in pool.map(lambda entry: fault_of(entry, folder, tool), entries) if fault]
    print("\n".join(faults), end="")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main(*sys.argv[1:])
