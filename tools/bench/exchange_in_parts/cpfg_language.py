"""The language of cpfg: its preprocessor, its statements, and the derivation of words."""
import math
import re

from exchange_in_parts.cpfg_view import View
from exchange_in_parts.turtle import TooLong

NAME = r'[A-Za-z_]\w*'


MOST_TRIES = 500_000


def held(number):
    """As a word holds it: by its decimal digits. cpfg has 32 bits, by which sums that ought to be equal differ."""
    return float(f'{number:.12g}')


class Refused(Exception):
    """What this derivation cannot do."""


def without_comments(text):
    text = re.sub(r'/\*.*?\*/', ' ', text, flags=re.S)
    return re.sub(r'(?m)(^|(?<=[ \t;]))//.*$', '', text)


class Preprocessor:
    def __init__(self, folder):
        self.folder, self.macros, self.depth = folder, {}, 0

    def read(self, text, stack=None):
        out, stack = [], stack if stack is not None else []
        text = without_comments(text.replace('\r\n', '\n').replace('\r', '\n'))
        text = re.sub(r'\\+\n', ' ', text)
        for line in text.split('\n'):
            match = re.match(r'\s*#\s*(\w+)\s*(.*)', line)
            if not match or match.group(1) not in ('define', 'undef', 'if', 'ifdef', 'ifndef', 'else', 'elif', 'endif',
                                                   'include', 'line', 'pragma'):
                out.append(self.expand(line) if all(s[0] for s in stack) else '')
                continue
            word, rest = match.groups()
            active = all(s[0] for s in stack)
            if word in ('if', 'ifdef', 'ifndef'):
                holds = self.holds(rest) if word == 'if' else (rest.strip() in self.macros) == (word == 'ifdef')
                stack.append([holds, holds])
            elif word in ('else', 'elif'):
                top = stack[-1]
                top[0] = not top[1] and (word == 'else' or self.holds(rest))
                top[1] = top[1] or top[0]
            elif word == 'endif':
                stack.pop()
            elif active and word == 'define':
                head = re.match(r'(%s)(\(([^)]*)\))?\s*(.*)' % NAME, rest)
                parameters = None if head.group(2) is None else [p.strip() for p in head.group(3).split(',')]
                self.macros[head.group(1)] = (parameters, head.group(4).strip())
            elif active and word == 'undef':
                self.macros.pop(rest.strip(), None)
            elif active and word == 'include':
                name = rest.strip().strip('"')
                path = self.folder / name
                if not path.exists() or self.depth > 20:
                    raise Refused(f'no file {name}')
                self.depth += 1
                out.append(self.read(path.read_bytes().decode('latin-1'), stack))
        return '\n'.join(out)

    def holds(self, text):
        text = re.sub(r'defined\s*\(?\s*(%s)\s*\)?' % NAME, lambda m: str(int(m.group(1) in self.macros)), text)
        text = re.sub(NAME, '0', self.expand(text))
        text = text.replace('&&', ' and ').replace('||', ' or ')
        return bool(eval(re.sub(r'!(?!=)', ' not ', text), {'__builtins__': {}}))

    def expand(self, text, busy=()):
        out, at = [], 0
        for match in re.finditer(r'"[^"]*"|\.?\d[\w.]*|' + NAME, text):
            if match.start() < at:
                continue
            out.append(text[at:match.start()])
            at = match.end()
            macro = self.macros.get(match.group())
            if macro is None or match.group() in busy:
                out.append(match.group())
                continue
            parameters, body = macro
            if parameters is not None:
                begin = re.compile(r'\s*\(').match(text, at)
                if not begin:
                    out.append(match.group())
                    continue
                arguments, depth, at = [''], 1, begin.end()
                while at < len(text) and depth:
                    c = text[at]
                    depth += (c == '(') - (c == ')')
                    if c == ',' and depth == 1:
                        arguments.append('')
                    elif depth:
                        arguments[-1] += c
                    at += 1
                values = {p: self.expand(a.strip(), busy) for p, a in zip(parameters, arguments)}
                body = re.sub(NAME, lambda m: values.get(m.group(), m.group()), body)
            out.append(self.expand(body, (*busy, match.group())))
        return ''.join(out) + text[at:]


def outside(text, characters, begin=0):
    depth = 0
    for at in range(begin, len(text)):
        if depth == 0 and text[at] in characters:
            return at
        depth += (text[at] in '(') - (text[at] in ')')
    return -1


FUNCTIONS = {'sin': lambda x: math.sin(math.radians(x)), 'cos': lambda x: math.cos(math.radians(x)),
             'tan': lambda x: math.tan(math.radians(x)), 'asin': lambda x: math.degrees(math.asin(x)),
             'acos': lambda x: math.degrees(math.acos(x)), 'atan': lambda x: math.degrees(math.atan(x)),
             'atan2': lambda y, x: math.degrees(math.atan2(y, x)), 'sqrt': math.sqrt, 'exp': math.exp, 'log': math.log,
             'floor': math.floor, 'ceil': math.ceil, 'fabs': abs, 'sign': lambda x: (x > 0) - (x < 0),
             'trunc': lambda x: math.floor(x + 0.5)}


def divided(a, b):
    if b == 0:
        raise Refused('a division by zero')
    return a / b


class Expressions:
    """Expressions of cpfg as functions of Python, by precedence climbing; names are looked up in `scope`."""
    TOKEN = re.compile(r'\s*(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?|%s|&&|\|\||==|!=|<>|<=|>=|"[^"]*"|\S)'
                       % NAME)
    LEVELS = ['?', '||', '&&', ('==', '!=', '<>'), ('<', '>', '<=', '>='), ('+', '-'), ('*', '/', '%'), '^']

    def __init__(self, view):
        self.view, self.known = view, {}

    def compiled(self, text):
        if text not in self.known:
            self.tokens, self.at = self.TOKEN.findall(text), 0
            code = self.ternary()
            if self.at < len(self.tokens):
                raise Refused(f'the expression {text}')
            self.known[text] = eval('lambda scope: ' + code, {'call': self.call, 'divided': divided, 'math': math,
                                                               'element': self.element, 'power': self.power})
        return self.known[text]

    def peek(self):
        return self.tokens[self.at] if self.at < len(self.tokens) else ''

    def take(self):
        self.at += 1
        return self.tokens[self.at - 1] if self.at <= len(self.tokens) else ''

    def ternary(self):
        condition = self.binary(1)
        if self.peek() != '?':
            return condition
        self.take()
        then = self.ternary()
        if self.take() != ':':
            raise Refused("'?' without ':'")
        return f'({then} if {condition} else {self.ternary()})'

    def binary(self, level):
        if level == len(self.LEVELS):
            return self.unary()
        left = self.binary(level + 1)
        while self.peek() and self.peek() in self.LEVELS[level]:
            op = self.take()
            right = self.binary(level + 1)
            if op == '/':
                left = f'divided({left}, {right})'
            elif op == '^':
                left = f'power({left}, {right})'
            elif op == '%':
                left = f'math.fmod({left}, {right})'
            elif op in ('&&', '||'):
                left = f'float(bool({left}) {"and" if op == "&&" else "or"} bool({right}))'
            elif op in ('<>', '!=', '==', '<', '>', '<=', '>='):
                left = f'float({left} {"!=" if op == "<>" else op} {right})'
            else:
                left = f'({left} {op} {right})'
        return left

    def unary(self):
        token = self.take()
        if token == '-':
            return f'(-{self.binary(len(self.LEVELS) - 1)})'
        if token == '+':
            return self.binary(len(self.LEVELS) - 1)
        if token == '!':
            return f'float(not {self.unary()})'
        if token == '(':
            inside = self.ternary()
            if self.take() != ')':
                raise Refused("'(' that is not closed")
            return f'({inside})'
        if token.startswith('"'):
            return '0.0'  # of a label
        if re.match(r'[\d.]', token):
            return f'{float(token)!r}'
        if not re.match(NAME, token):
            raise Refused(f"'{token}' in an expression")
        if self.peek() == '(':
            self.take()
            arguments = []
            if token == 'func' and self.peek() in self.view.named:
                arguments.append(repr(float(self.view.named[self.take()])))
                self.take()
            while self.peek() != ')':
                arguments.append(self.ternary())
                if self.peek() == ',':
                    self.take()
                elif not self.peek():
                    raise Refused("'(' that is not closed")
            self.take()
            return f'call({token!r}, [{", ".join(arguments)}])'
        if self.peek() == '[':
            indices = []
            while self.peek() == '[':
                self.take()
                indices.append(self.ternary())
                self.take()
            return f'element(scope, {token!r}, [{", ".join(indices)}])'
        return f'scope[{token!r}]'

    @staticmethod
    def power(a, b):
        try:
            return math.pow(a, b)
        except (ValueError, OverflowError) as fault:
            raise Refused('a power without a value') from fault

    @staticmethod
    def element(scope, name, indices):
        array = scope[name]
        for index in indices:
            if not 0 <= int(index) < len(array):
                raise Refused('an index out of range')
            array = array[int(index)]
        return array

    def call(self, name, arguments):
        if name == 'func':
            return self.view.function(arguments[0], arguments[1])
        if name not in FUNCTIONS:
            raise Refused(f"the function '{name}'")
        return float(FUNCTIONS[name](*arguments))


class Scope(dict):
    """Values by their names: those of a production hide those of the model; what is not known is 0, as in cpfg."""

    def __init__(self, outer=None):
        super().__init__()
        self.outer = outer

    def __missing__(self, name):
        if self.outer is not None and name in self.outer:
            return self.outer[name]
        raise Refused(f"'{name}' has no value")

    def assign(self, name, value):
        if name not in self and self.outer is not None and name in self.outer:
            self.outer[name] = value
        else:
            self[name] = value


class Block:
    """Statements between braces."""

    def __init__(self, text, expressions):
        self.text, self.at, self.expressions = text.strip(), 0, expressions
        if self.text.startswith('{'):
            self.text = self.text[1:]
        self.actions = self.statements()

    def skip(self):
        while self.at < len(self.text) and self.text[self.at] in ' \t\n;':
            self.at += 1

    def statements(self):
        actions = []
        while True:
            self.skip()
            if self.at >= len(self.text):
                return actions
            if self.text[self.at] == '}':
                self.at += 1
                return actions
            actions.append(self.statement())

    def parenthesis(self):
        begin = self.at = self.text.index('(', self.at) + 1
        depth = 1
        while depth:
            depth += (self.text[self.at] == '(') - (self.text[self.at] == ')')
            self.at += 1
        return self.expressions.compiled(self.text[begin:self.at - 1])

    def statement(self):
        self.skip()
        if self.text[self.at] == '{':
            self.at += 1
            return ('all', self.statements())
        word = re.compile(r'\w*').match(self.text, self.at).group()
        if word == 'if':
            condition, then = self.parenthesis(), self.statement()
            self.skip()
            otherwise = None
            if re.compile(r'else\b').match(self.text, self.at):
                self.at += 4
                otherwise = self.statement()
            return ('if', condition, then, otherwise)
        if word == 'while':
            return ('while', self.parenthesis(), self.statement())
        if word == 'do':
            self.at += 2
            body = self.statement()
            self.skip()
            return ('do', self.parenthesis(), body)
        begin, quoted = self.at, False
        while self.at < len(self.text) and (quoted or self.text[self.at] not in ';}'):
            quoted ^= self.text[self.at] == '"'
            self.at += 1
        text = self.text[begin:self.at].strip()
        if word in ('printf', 'fprintf', 'fflush', 'fclose', 'srand', 'play') or 'fopen' in text:
            return ('all', [])
        match = re.match(r'(%s)\s*((?:\[[^\]]*\])*)\s*=(?!=)(.*)' % NAME, text, re.S)
        if not match:
            raise Refused(f"the statement '{word}'")
        indices = [self.expressions.compiled(i) for i in re.findall(r'\[([^\]]*)\]', match.group(2))]
        return ('set', match.group(1), indices, self.expressions.compiled(match.group(3)))

    def run(self, scope):
        self.budget = 10_000_000
        self.carry_out(('all', self.actions), scope)

    def carry_out(self, action, scope):
        self.budget -= 1
        if self.budget < 0:
            raise TooLong
        if action[0] == 'all':
            for inner in action[1]:
                self.carry_out(inner, scope)
        elif action[0] == 'if':
            if action[1](scope):
                self.carry_out(action[2], scope)
            elif action[3]:
                self.carry_out(action[3], scope)
        elif action[0] == 'while':
            while action[1](scope):
                self.carry_out(action[2], scope)
        elif action[0] == 'do':
            self.carry_out(action[2], scope)
            while action[1](scope):
                self.carry_out(action[2], scope)
        else:
            _, name, indices, value = action
            if not indices:
                scope.assign(name, value(scope))
                return
            array = scope[name]
            for index in indices[:-1]:
                array = array[int(index(scope))]
            array[int(indices[-1](scope))] = value(scope)


class Production:
    def __init__(self):
        self.left, self.strict, self.right, self.successor = [], [], [], []
        self.before = self.after = self.condition = None


class Language:
    def __init__(self, path, text, most):
        self.most, self.view = most, View(path)
        self.expressions = Expressions(self.view)
        self.globals, self.blocks = Scope(), {}
        self.sections = {'production': [], 'homomorphism': [], 'decomposition': []}
        self.depths = {'homomorphism': 1, 'decomposition': 1}
        self.ignored, self.considered, self.has_queries = None, None, False
        self.axiom_text, self.length, self.work = None, '1', 0
        self.read(Preprocessor(path.parent).read(text))
        self.homomorphism = self.by_symbol('homomorphism')
        self.decomposition = self.by_symbol('decomposition')
        self.productions = self.by_symbol('production')

    def by_symbol(self, section):
        table = {}
        for production in self.sections[section]:
            table.setdefault(production.strict[0][0], []).append(production)
        return table

    def statements(self, text):
        current = ''
        for line in text.split('\n'):
            colon = current.find(':')
            arrow = current.find('-->')
            head = current[colon + 1:arrow if arrow >= 0 else None] if colon >= 0 else ''
            if current.strip() and (line.startswith('\t') or head.count('{') > head.count('}')):
                current += ' ' + line
                continue
            if current.strip():
                yield current.strip()
            current = line
        if current.strip():
            yield current.strip()

    def read(self, text):
        section, systems = 'production', 0
        for statement in self.statements(text):
            small = statement[:24].lower()
            value = statement[statement.find(':') + 1:].strip()
            if small.startswith('lsystem:'):
                systems += 1
                if systems > 1:
                    raise Refused('sub-L-systems')
            elif small.startswith('seed:'):
                if section == 'production':
                    raise Refused('chance')
            elif re.match(r'derivation ?length:', small):
                self.length = value
            elif small.startswith('maximum depth:'):
                self.depths[section] = int(self.number(value))
            elif small.startswith('ignore:'):
                self.ignored = set(value.replace(' ', ''))
            elif small.startswith('consider:'):
                self.considered = set(value.replace(' ', ''))
            elif small.startswith('axiom:'):
                self.axiom_text = self.string(value)
            elif match := re.match(r'(start|end)( ?each)?:', small):
                self.blocks[match.group(1) + ('each' if match.group(2) else '')] = Block(value, self.expressions)
            elif small.startswith('define:'):
                self.define(value)
            elif small.startswith('ring'):
                raise Refused('a ring')
            elif small.startswith('homomorphism'):
                section = 'homomorphism'
            elif small.startswith('decomposition'):
                section = 'decomposition'
            elif small.startswith('endlsystem'):
                section = 'production'
            elif '-->' in statement:
                self.sections[section].append(self.production(statement, section))
            else:
                raise Refused(f'the statement {statement[:40]}')

    def number(self, text):
        return self.expressions.compiled(text)(self.globals)

    def define(self, text):
        for match in re.finditer(r'(%s)\s*((?:\[[^\]]*\])+)\s*(?:=\s*\{([^}]*)\})?' % NAME, text):
            sizes = [int(self.number(s)) for s in re.findall(r'\[([^\]]*)\]', match.group(2))]
            values = [self.number(v) for v in (match.group(3) or '').split(',') if v.strip()]
            values += [0.0] * (math.prod(sizes) - len(values))

            def nested(sizes, values):
                if len(sizes) == 1:
                    return values
                step = len(values) // sizes[0]
                return [nested(sizes[1:], values[i * step:(i + 1) * step]) for i in range(sizes[0])]
            self.globals[match.group(1)] = nested(sizes, values)

    def string(self, text):
        """[(symbol, expressions)]"""
        modules, at = [], 0
        while at < len(text):
            c = text[at]
            at += 1
            if c.isspace():
                continue
            symbol = c
            if (c in '@~' or (c == '?' and text[at:at + 1] in tuple('PHLUEQ'))) and at < len(text):
                symbol += text[at]
                at += 1
                if c == '@' and symbol[1] in 'GPTDbm' and text[at:at + 1].isalpha():
                    symbol += text[at]
                    at += 1
            parameters = []
            match = re.compile(r' *\(').match(text, at)
            if match:
                begin = at = match.end()
                depth = 1
                while depth:
                    if at >= len(text):
                        raise Refused("'(' that is not closed")
                    depth += (text[at] == '(') - (text[at] == ')')
                    at += 1
                inside = text[begin:at - 1]
                while inside.strip():
                    comma = outside(inside, ',')
                    parameters.append((inside if comma < 0 else inside[:comma]).strip())
                    inside = '' if comma < 0 else inside[comma + 1:]
                if symbol in '[]{}' or symbol in ('?',):
                    if symbol == '?':
                        raise Refused('sub-L-systems')
            if symbol == '?E':
                raise Refused('an environment')
            if symbol == '$':
                raise Refused('sub-L-systems')
            self.has_queries |= symbol[0] == '?'
            modules.append((symbol, parameters))
        return modules

    def production(self, statement, section):
        out = Production()
        arrow = statement.index('-->')
        head, tail = statement[:arrow], statement[arrow + 3:]
        colon = outside(head, ':')
        strict = head if colon < 0 else head[:colon]
        less = outside(strict, '<')
        if less >= 0:
            if strict[:less].strip() != '*':
                out.left = self.string(strict[:less])
            strict = strict[less + 1:]
        more = outside(strict, '>')
        if more >= 0:
            if strict[more + 1:].strip() != '*':
                out.right = self.string(strict[more + 1:])
            strict = strict[:more]
        out.strict = self.string(strict)
        if section == 'homomorphism':
            out.left = out.right = []  # cpfg says so, and goes on
        if not out.strict:
            raise Refused('a production without a predecessor')
        if colon >= 0:
            condition = head[colon + 1:].strip()
            if condition.startswith('{'):
                end, depth = 0, 0
                while True:
                    depth += (condition[end] == '{') - (condition[end] == '}')
                    end += 1
                    if depth == 0:
                        break
                out.before, condition = Block(condition[:end], self.expressions), condition[end:].strip()
            if '{' in condition:
                brace = condition.index('{')
                out.after, condition = Block(condition[brace:], self.expressions), condition[:brace].strip()
            if condition not in ('', '*'):
                out.condition = self.expressions.compiled(condition)
        chance = outside(tail, ':')
        successor = tail if chance < 0 else tail[:chance]
        if successor.strip() != '*':
            out.successor = [(s, [self.expressions.compiled(p) for p in ps]) for s, ps in self.string(successor)]
        return out

    # ------------------------------------------------------------------------------------------ derivation

    def axiom(self):
        if self.axiom_text is None:
            raise Refused('no axiom')
        if 'start' in self.blocks:
            self.blocks['start'].run(self.globals)
        return [(s, tuple(held(self.expressions.compiled(p)(self.globals)) for p in ps))
                for s, ps in self.axiom_text]

    def steps(self):
        return int(self.number(self.length))

    def is_ignored(self, symbol):
        if self.considered is not None:
            return symbol[0] not in self.considered
        return self.ignored is not None and symbol[0] in self.ignored

    def match(self, wanted, word, at, scope):
        symbol, names = wanted
        found, values = word[at]
        if symbol != found or len(names) != len(values):
            return False
        scope.update(zip(names, values))
        return True

    def match_right(self, context, word, at, scope):
        place = 0
        while place < len(context):
            wanted = context[place]
            if wanted[0] == '=':
                level = 0
                while at < len(word):
                    if word[at][0] == '[':
                        level += 1
                    elif word[at][0] == ']':
                        if level == 0:
                            break
                        level -= 1
                    at += 1
                place += 1
                continue
            if at >= len(word):
                return False
            symbol = word[at][0]
            if self.is_ignored(symbol):
                at += 1
            elif wanted[0] != '[' and symbol == '[':
                level = 1
                at += 1
                while at < len(word) and level:
                    level += (word[at][0] == '[') - (word[at][0] == ']')
                    at += 1
            else:
                if not self.match(wanted, word, at, scope):
                    return False
                at += 1
                place += 1
        return True

    def match_left(self, context, word, at, scope):
        place = len(context) - 1
        while place >= 0:
            if at < 0:
                return False
            symbol = word[at][0]
            if symbol == ']':
                level = 1
                at -= 1
                while at >= 0 and level:
                    level += (word[at][0] == ']') - (word[at][0] == '[')
                    at -= 1
            elif symbol == '[' or self.is_ignored(symbol):
                at -= 1
            else:
                if not self.match(context[place], word, at, scope):
                    return False
                at -= 1
                place -= 1
        return True

    def holds(self, production, scope):
        if production.before:
            production.before.run(scope)
        return production.condition is None or production.condition(scope)

    def successor(self, production, scope):
        if production.after:
            production.after.run(scope)
        return [(s, tuple(held(p(scope)) for p in ps)) for s, ps in production.successor]

    def try_alone(self, production, parameters):
        self.work += 1
        if self.work > MOST_TRIES:
            raise TooLong
        if len(production.strict) != 1:
            raise Refused('a homomorphism of several modules')
        if len(production.strict[0][1]) != len(parameters):
            return None
        scope = Scope(self.globals)
        scope.update(zip(production.strict[0][1], parameters))
        return self.successor(production, scope) if self.holds(production, scope) else None

    def decomposed(self, module, depth, out):
        if depth < self.depths['decomposition']:
            for production in self.decomposition.get(module[0], ()):
                if production.left or production.right:
                    raise Refused('a context of a decomposition')
                successor = self.try_alone(production, module[1])
                if successor is not None:
                    for inner in successor:
                        self.decomposed(inner, depth + 1, out)
                    return
        out.append(module)
        if len(out) > self.most:
            raise TooLong

    def derive(self, word, last):
        if 'starteach' in self.blocks:
            self.blocks['starteach'].run(self.globals)
        out, at = [], 0
        while at < len(word):
            for production in self.productions.get(word[at][0], ()):
                strict = production.strict
                if at + len(strict) > len(word):
                    continue
                scope = Scope(self.globals)
                self.work += 1
                if self.work > MOST_TRIES:
                    raise TooLong
                if all(self.match(w, word, at + i, scope) for i, w in enumerate(strict)) and \
                        self.match_right(production.right, word, at + len(strict), scope) and \
                        self.match_left(production.left, word, at - 1, scope) and self.holds(production, scope):
                    for module in self.successor(production, scope):
                        self.decomposed(module, 0, out)
                    at += len(strict)
                    break
            else:
                if word[at][0] == '%':
                    level = 1
                    while at < len(word):
                        level += (word[at][0] == '[') - (word[at][0] == ']')
                        if level == 0:
                            break
                        at += 1
                    continue
                self.decomposed(word[at], 0, out)
                at += 1
            if len(out) > self.most:
                raise TooLong
        if 'endeach' in self.blocks:
            self.blocks['endeach'].run(self.globals)
        if last and 'end' in self.blocks:
            self.blocks['end'].run(self.globals)
        return out
