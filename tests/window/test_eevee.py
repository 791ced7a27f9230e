# EEVEE, which needs a screen, draws what the node group of a relightable bake says. Runs outside Blender.
import os
import pathlib
import shutil
import subprocess

TESTS = pathlib.Path(__file__).resolve().parents[1]


def test_eevee_draws_the_node_group_of_a_relightable_bake():
    assert shutil.which("xvfb-run"), "the window tests need xvfb-run, of Debian's package xvfb"
    blender = os.environ.get("MESOGRAIN_BLENDER", "blender")
    done = subprocess.run(
        ["xvfb-run", "--auto-servernum", blender, "-b", "--factory-startup", "--python-exit-code", "1", "--python",
         str(TESTS / "blender/run.py"), "--", "-q", str(TESTS / "blender/test_relightable.py"), "-k",
         "sum_of_products"],
        capture_output=True, text=True, timeout=600, check=False)
    assert done.returncode == 0 and "2 passed" in done.stdout, done.stdout + done.stderr
