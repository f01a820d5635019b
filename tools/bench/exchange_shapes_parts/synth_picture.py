"""The picture of Structure Synth, which has a window only: Xvfb shows it, xdotool presses the key, ffmpeg takes the view.
Packages: structure-synth, xvfb, xdotool."""
import os
import shutil
import subprocess
import tempfile
import time

DISPLAY = ':77'
SCREEN = '1300x1000'
VIEW = 'crop=772:426:410:309'  # the view in the window, as it opens
START_S, BUILD_S = 8, 14


def draw(script, picture, size, seconds):
    if not all(shutil.which(name) for name in ('structure-synth', 'Xvfb', 'xdotool')):
        return
    with tempfile.TemporaryDirectory() as home:
        around = dict(os.environ, DISPLAY=DISPLAY, HOME=home, LIBGL_ALWAYS_SOFTWARE='1', XDG_RUNTIME_DIR=home)
        quiet = {'stdout': subprocess.DEVNULL, 'stderr': subprocess.DEVNULL, 'stdin': subprocess.DEVNULL}
        screen = subprocess.Popen(['Xvfb', DISPLAY, '-screen', '0', SCREEN + 'x24'], **quiet)
        time.sleep(1)
        window = subprocess.Popen(['structure-synth', str(script.resolve())], env=around, cwd=home, **quiet)
        try:
            time.sleep(START_S)
            found = subprocess.run(['xdotool', 'search', '--name', 'Structure Synth'], env=around, capture_output=True,
                                   timeout=seconds).stdout.split()
            if found:
                subprocess.run(['xdotool', 'windowfocus', found[-1], 'key', '--window', found[-1], 'F5'], env=around,
                               timeout=seconds, check=False, **quiet)
                time.sleep(BUILD_S)
                subprocess.run(['ffmpeg', '-v', 'error', '-y', '-f', 'x11grab', '-video_size', SCREEN, '-i', DISPLAY,
                                '-frames:v', '1', '-vf', f'{VIEW},scale={size}:-2', str(picture)], env=around,
                               timeout=seconds, check=False, **quiet)
        finally:
            for process in (window, screen):
                process.kill()
                process.wait()
