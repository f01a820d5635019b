"""The commit that figures are measured at."""
import subprocess


def name(root):
    """Its short name; a plus sign follows where the program's sources differ from it."""
    def git(*words):
        return subprocess.run(['git', '-C', root, *words], check=True, capture_output=True, text=True).stdout.strip()
    changed = git('status', '--porcelain', '--untracked-files=no', 'compiler', 'runtime', 'tools/graftal')
    return git('rev-parse', '--short=7', 'HEAD') + ('+' if changed else '')
