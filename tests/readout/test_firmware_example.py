"""The C of docs/readout.md, compiled: what it sends is read here, frame by frame."""

import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from skinfab.readout.decode import PacketDecoder

PAGE = Path(__file__).parents[2] / "docs/readout.md"

BOARD = """
#include <stdio.h>
static uint64_t now = 0;
uint64_t micros(void) { return now += 10000; }
void port_write(const void *data, uint32_t size) { fwrite(data, 1, size, stdout); }
int main(void) {
    for (uint32_t k = 0; k < 300; k++) {
        if (k % 100 == 0) send_description();
        float volts[CHANNELS];
        for (int c = 0; c < CHANNELS; c++) volts[c] = (float)k / 8 + (float)c;
        send_frame(k + 4294967200u, volts);
    }
    return 0;
}
"""


@pytest.mark.parametrize("channels", [2, 9, 70])
def test_what_it_sends_is_read(tmp_path: Path, channels: int) -> None:
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler on this machine")
    code = re.search(r"```c\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert code is not None
    names = ",".join(f'{{\\"name\\":\\"S{k + 1}\\",\\"unit\\":\\"V\\"}}' for k in range(channels))
    source, count = re.subn(r'"\{\\"name\\":\\"S1\\".*?\]\}"', lambda m: f'"{names}]}}"', code[1])
    assert count == 1
    (tmp_path / "a.c").write_text(source.replace("#define CHANNELS 2", f"#define CHANNELS {channels}") + BOARD)
    subprocess.run([compiler, "-std=gnu11", "-Wall", "-Wextra", "-Werror", "-o", "a", "a.c"], cwd=tmp_path, check=True)
    sent = subprocess.run([tmp_path / "a"], stdout=subprocess.PIPE, check=True).stdout
    decoder = PacketDecoder()
    frames = decoder.feed(sent, host_time=0.0)
    assert decoder.bad == 0 and len(frames) == 300 and decoder.stream is not None and len(decoder.stream.channels) == channels
    for k, frame in enumerate(frames):
        assert frame.sequence == (k + 4294967200) % 2**32 and frame.device_time == pytest.approx((k + 1) / 100)
        np.testing.assert_array_equal(frame.values, k / 8 + np.arange(channels))
        assert frame.valid.all() and not frame.saturated.any()
