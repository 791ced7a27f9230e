"""Runs Blender for the launcher: its own chatter on standard output goes to a log, the rest to the terminal.

    run_blender.py LOG BLENDER [argument ...]

Signals reach Blender once, and its exit code is passed on.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile

CHATTER = re.compile(
    rb"^(Blender \d|Read (blend|prefs|new)|Fra:\d|Saved: |Saving: |Blender quit|Info: |\s*Time: |Writing |Writing: |"
    rb"found bundled python|Color management: |AL lib: |addon_utils\.|reloading addon|module changed|Modules Installed|"
    rb"Warning: Add-on path|STATUS |\s*$)")


def run(log_path, command):
    """Returns the exit code: Blender's, 130 or 143 when it was interrupted, 1 when it crashed."""
    os.makedirs(os.path.dirname(log_path), exist_ok=True)
    received = []
    with open(log_path, "wb") as log, tempfile.TemporaryDirectory(prefix="mesograin-") as folder:
        # What a command looks at once it can be interrupted: a Blender that starts swallows the first SIGINT.
        asked = pathlib.Path(folder) / "interrupted"
        # A session of its own: Ctrl-C in the terminal would otherwise reach Blender twice.
        blender = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, start_new_session=True,
                                   env={**os.environ, "MESOGRAIN_INTERRUPTED": str(asked)})

        def pass_on(number, _frame):
            received.append(number)
            asked.touch()
            # The second request is meant: Blender may hang where it looks at no signal.
            blender.send_signal(number if len(received) == 1 else signal.SIGKILL)

        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, pass_on)
        for line in blender.stdout:
            log.write(line)
            log.flush()
            if not CHATTER.match(line):
                sys.stdout.buffer.write(line)
                sys.stdout.buffer.flush()
        code = blender.wait()
    if received:
        return 128 + received[0]
    if code < 0:
        print(f"mesograin: Blender ended by signal {-code} ({signal.Signals(-code).name}); its log: {log_path}",
              file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(run(sys.argv[1], sys.argv[2:]))
