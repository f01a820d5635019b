"""The names by which commands take the models of a file."""
import re

HEADINGS = {'.ifs': r'(?m)^\s*([^\s{(;][^{(;\n]*?)\s*(?:\(3[dD]\)\s*)?\{',
            '.flame': r'<flame\b[^>]*?\bname="([^"]*)"', '.flam3': r'<flame\b[^>]*?\bname="([^"]*)"'}


def models(path):
    heading = HEADINGS.get(path.suffix.lower())
    names = re.findall(heading, path.read_text('latin-1')) if heading else []
    names = [name for name in names if name.lower() != 'comment']
    return [f'{path}:{name}' for name in names] if len(names) > 1 else [str(path)]
