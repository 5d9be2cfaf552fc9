"""Runs in .venv-printrun, not under pytest: printrun reads or sends a file, pyGCodeDecode times it; the result is one JSON object.

python with_printrun.py read FILE
python with_printrun.py send FILE HOST:PORT give-up|resume|restart
python with_printrun.py time FILE PRESETS.yaml
"""

import json
import logging
import sys
import threading
import time

#: Longer than any answer over loopback takes, s.
PATIENCE_S = 20.0


def read(file: str) -> dict[str, object]:
    """What printrun's reader makes of a file: the highest and the last sum of E, and the box of what extrudes."""
    from printrun import gcoder

    with open(file, encoding="utf-8") as lines:
        code = gcoder.GCode(lines.read().split("\n"))
    box = (code.xmin, code.ymin), (code.xmax, code.ymax)
    return {"most_e": code.filament_length, "last_e": code.total_e, "box": box, "lines": len(code.lines), "relative_e": code.relative_e}


def send(file: str, address: str, after_a_drop: str) -> dict[str, object]:
    """Stream a file with line numbers and checksums; after a dropped connection give up, go on, or begin again."""
    from printrun import device, gcoder, printcore

    logging.disable(logging.CRITICAL)  # its own account of a lost connection; `errors` has it
    # Over a socket printrun trusts TCP and leaves line numbers and checksums out. What is behind a network bridge is
    # a serial line all the same, so that trust is taken from it here.
    device.Device.has_flow_control = property(lambda self: False)
    errors: list[str] = []
    lost, online, done = threading.Event(), threading.Event(), threading.Event()

    def failed(error: str) -> None:
        errors.append(error)
        if "disconnected?" in error or "Connection lost" in error:
            lost.set()

    sender = printcore.printcore()
    sender.errorcb, sender.onlinecb, sender.endcb = failed, online.set, done.set
    sender.recvcb = lambda line: answers.append(line.strip())
    sender.sendcb = lambda command, _: sent.append(command)
    with open(file, encoding="utf-8") as lines:
        job = gcoder.LightGCode(lines.read().split("\n"))

    answers: list[str] = []
    sent: list[str] = []

    def leave() -> None:
        # At its end its print thread forgets itself, calls `endcb` before that and starts the send thread after it, and
        # `disconnect` trips over a thread that is not started yet. So the thread itself is waited for, by its name.
        sender.printing = False
        for thread in threading.enumerate():
            if thread.name == "print thread":
                thread.join(PATIENCE_S)
        sender.disconnect()

    def unanswered() -> int:
        return len(sent) - sum(a.startswith("ok") for a in answers)

    def stream(first: int) -> bool:
        online.clear(), done.clear(), lost.clear()
        before = unanswered()
        sender.connect(address, 115200)
        if not online.wait(PATIENCE_S) or not sender.startprint(job, first):
            return False
        until = time.monotonic() + PATIENCE_S
        # Its end is when the last line was sent; hanging up before the answers are read would cut off what is on the way.
        while not ((done.is_set() and unanswered() == before) or lost.is_set()) and time.monotonic() < until:
            time.sleep(0.005)
        return done.is_set() and unanswered() == before and not lost.is_set()

    finished, at = stream(0), None
    if lost.is_set():
        # The printer obeys one line for each plain ok, less the one for M110 and those that end a request to send again.
        obeyed = answers.count("ok") - 1 - sum(a.startswith("Resend") for a in answers)
        at = [k for k, line in enumerate(job.lines) if line.raw.partition(";")[0].strip()][obeyed]
        leave()
        if after_a_drop != "give-up":
            finished = stream(at if after_a_drop == "resume" else 0)
    leave()
    return {"finished": finished, "errors": errors, "dropped_at": at}


def planned_time(file: str, presets: str) -> dict[str, object]:
    """What another planner says a file of straight moves takes, s."""
    from pyGCodeDecode.gcode_interpreter import setup, simulation

    simulated = simulation(gcode_path=file, initial_machine_setup=setup(presets, "ours", verbosity_level=0), verbosity_level=0)
    return {"seconds": float(simulated.blocklist[-1].get_segments()[-1].t_end), "moves": len(simulated.blocklist)}


if __name__ == "__main__":
    what, *words = sys.argv[1:]
    sys.stdout.write(json.dumps({"read": read, "send": send, "time": planned_time}[what](*words)))
