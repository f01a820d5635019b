"""The names by which commands take the models of a file."""
import re

SYSTEM = re.compile(r'(?m)^\s*([^\s{(;][^{(;\n]*?)\s*(?:\(3[dD]\)\s*)?\{')
FLAME = re.compile(r'<flame\b([^>]*)>')


def models(path):
    text, names = path.read_text('latin-1'), []
    if path.suffix.lower() == '.ifs':
        names = [name for name in SYSTEM.findall(text) if name.lower() != 'comment']
    elif path.suffix.lower() in ('.flame', '.flam3'):
        for number, attributes in enumerate(FLAME.findall(text), 1):
            named = re.search(r'\bname="([^"]+)"', attributes)
            names.append(named[1] if named else f'flame{number}')
    return [f'{path}:{name}' for name in names] if len(names) > 1 else [str(path)]
