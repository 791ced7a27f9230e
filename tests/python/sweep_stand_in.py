"""A folder with a sweep of six cases, and a stand-in for Blender that renders nothing and can be told to fail."""
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
COMMAND = ROOT / "addon/mesograin/studies/sweep/command.py"

STAND_IN = """\
#!{python}
import json, os, sys, time
words = sys.argv[sys.argv.index("--") + 1:]
out = words[words.index("--out") + 1]
settings = dict(word.split("=") for at, word in enumerate(words) if words[at - 1] == "--set")
with open({runs!r}, "a") as runs:
    runs.write(settings["scale"] + "\\n")
time.sleep(float(os.environ.get("STAND_IN_SECONDS", "0")))
together = int(os.environ.get("STAND_IN_TOGETHER", "0"))
began = time.time()
while len(open({runs!r}).readlines()) < together:
    time.sleep(0.02)
    if time.time() > began + 30:
        sys.exit("The others did not come.")
if os.environ.get("STAND_IN_FAILS") == settings["scale"]:
    print("compare: the reference could not be rendered.\\n")
    print("Error: script failed, file: 'command.py', exiting.\\nBlender quit")
    sys.exit(1)
scale = float(settings["scale"])
result = {{"model": words[words.index("--models") + 1], "reference": "volume_index_matched",
          "metrics": {{"relative_l1": 1 / scale, "rse_mean": 0.1 / scale, "bias": 1.0, "max_error_at": [1, 2, 0]}},
          "noise_floor": {{"relative_l1": 0.01}}, "mask": {{"pixels": 9, "nan": 0, "inf": 0}},
          "files": {{"model": "model.exr", "model_png": "model.png", "error_png": "error.png"}},
          "frame_ms": time.time(), "reference_seconds": 1.5}}
for name in ("model", "error"):
    with open(os.path.join(out, name + ".png"), "wb") as file:
        file.write(name.encode())
if "--controls" in words:
    # The identical material is called different at scale 1, the wrong one is not at scale 4.
    test = {{"differs": {{"verdict": "differs", "share": 0.1, "share_blocks": 0.5}},
            "same": {{"verdict": "no significant difference", "share": 0.0, "share_blocks": 0.0}}}}
    result["controls"] = {{"identical": test["differs" if scale == 1 else "same"],
                          "wrong": {{**test["same" if scale == 4 else "differs"], "change": {{"scale": 2 * scale}}}}}}
made = {{"versions": {{"mesograin": "0.1.0", "blender": "3.4.1 (abc)", "python": "3.11", "numpy": "1.24"}},
        "device": {{"renderer": "llvmpipe", "version": "4.5"}},
        "cpu": {{"name": "A CPU", "cores": 2, "machine": "x86_64"}}}}
with open(os.path.join(out, "results.json"), "w") as file:
    json.dump({{**made, "cases": [result]}}, file)
"""

SWEEP = """\
title = "Test"
scenes = ["a.blend"]
models = ["model_1", "model_2"]
[grid]
scale = [1, 2, 4]
"""


def fill(folder):
    """Writes the sweep, its scene and the stand-in into a folder."""
    (folder / "a.blend").write_bytes(b"BLENDER")
    (folder / "s.toml").write_text(SWEEP)
    stand_in = folder / "blender"
    stand_in.write_text(STAND_IN.format(python=sys.executable, runs=str(folder / "runs")))
    stand_in.chmod(0o755)


def words(folder, *more, out="out"):
    return [
        sys.executable,
        str(COMMAND),
        str(folder / "s.toml"),
        "--out",
        str(folder / out),
        "--blender",
        str(folder / "blender"),
        *([] if "--report" in more else ["--no-report"]),
        *(word for word in more if word != "--report"),
    ]


def run(folder, *more, out="out", **environment):
    return subprocess.run(
        words(folder, *more, out=out), capture_output=True, text=True, env={**os.environ, **environment}
    )


def runs(folder):
    path = folder / "runs"
    return len(path.read_text().splitlines()) if path.exists() else 0
