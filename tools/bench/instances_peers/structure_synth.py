"""Structure Synth has no command line: this opens it on a display of its own, runs a script in it by pressing F5,
and ends it when the script has exported the model."""
import os
import subprocess
import time

from limited import Died, run

# Written to the export, of the place of each part no more than POV-Ray needs.
TEMPLATE = '''<template defaultExtension="POV-Ray (*.inc)" name="parts">
<primitive name="begin"><![CDATA[union {
]]></primitive>
<primitive name="end"><![CDATA[}
]]></primitive>
<primitive name="box"><![CDATA[box { 0, 1 matrix <{povmatrix}> }
]]></primitive>
<primitive name="triangle"><![CDATA[triangle { <{p1x},{p1y},{p1z}>, <{p2x},{p2y},{p2z}>, <{p3x},{p3y},{p3z}> }
]]></primitive>
</template>
'''
SCRIPT = '''#javascript
Builder.execute("touch", "{folder}/synth.started", true);
Builder.load("{folder}/synth_model.es");
Builder.reset();
Builder.setSize(640, 360);
Builder.build();
Builder.templateRenderToFile("{folder}/parts.rendertemplate", "{folder}/synth.inc", true);
Builder.execute("touch", "{folder}/synth.done", true);
'''


class Display:
    """An X server without a screen, for as long as the benchmark runs."""

    def __init__(self):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ['Xvfb', '-displayfd', str(write), '-screen', '0', '1280x800x24', '-nolisten', 'tcp'],
            pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        os.close(write)
        number = b''
        while not number.endswith(b'\n'):
            byte = os.read(read, 1)
            if not byte:
                raise Died('no X server')
            number += byte
        os.close(read)
        self.environment = dict(os.environ, DISPLAY=f':{number.decode().strip()}', QT_LOGGING_RULES='*=false')

    def close(self):
        self.server.terminate()
        self.server.wait()


def export(display, folder, limits):
    """From synth_model.es in `folder` to synth.inc; returns the usage."""
    with open(f'{folder}/parts.rendertemplate', 'w') as file:
        file.write(TEMPLATE)
    with open(f'{folder}/synth_run.es', 'w') as file:
        file.write(SCRIPT.replace('{folder}', str(folder)))
    started, done = f'{folder}/synth.started', f'{folder}/synth.done'
    next_try = [0.0]

    def finished():
        if not os.path.exists(started) and time.monotonic() >= next_try[0]:
            next_try[0] = time.monotonic() + 1
            subprocess.run('w=$(xdotool search --onlyvisible --name "synth_run.es" | tail -1) && [ "$w" ] && '
                           'xdotool windowfocus "$w" key F5', shell=True, env=display.environment,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=20)
        return os.path.exists(done)

    for attempt in range(3):
        for leftover in (started, done, f'{folder}/synth.inc'):
            if os.path.exists(leftover):
                os.unlink(leftover)
        # What hangs does so before it begins: then again.
        begun = time.monotonic()

        def watched():
            if time.monotonic() - begun > 20 and not os.path.exists(started):
                return True
            return finished()

        usage = run(['structure-synth', f'{folder}/synth_run.es'], limits, f'{folder}/synth.log', folder,
                    display.environment, watched)
        if os.path.exists(done):
            return usage
    raise Died('does not start its script')
