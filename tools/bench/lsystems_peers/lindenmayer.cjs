// node lindenmayer.cjs PACKAGE_FOLDER SYSTEM STEPS
// Derives a system with the npm package `lindenmayer`, then follows it with callbacks for F + - [ ].
// Prints: modules, seconds of the derivation, seconds of the drawing, segments, width of the drawing.
const [folder, name, steps] = process.argv.slice(2);
const LSystem = require(folder);

const module_ = (symbol, ...params) => ({symbol, params});
const between = (low, high) => low + (high - low) * Math.random();
const twig = (l, first, last) => [
    module_('['), module_('&', between(first, last)), module_('A', l * between(0.6, 0.8)), module_(']'),
];
const systems = {
    single: {
        axiom: [module_('A', 1, 1)],
        productions: {
            A: ({params: [l, k]}) => [
                module_('F', l), module_('['), module_('+', 30 + k * 0.001), module_('A', l * 0.9, 2 * k), module_(']'),
                module_('['), module_('-', 25 + k * 0.001), module_('A', l * 0.8, 2 * k + 1), module_(']'),
            ],
        },
    },
    thicket: {
        axiom: [module_('!', 0.02), module_('A', 1)],
        productions: {
            A: ({params: [l]}) => [
                module_('F', l), module_('!', 0.02 * l), module_('/', between(0, 360)), ...twig(l, 20, 70),
                module_('/', between(100, 140)), ...twig(l, 20, 70), module_('/', between(100, 140)),
                ...twig(l, 10, 40),
            ],
        },
    },
    koch: {angle: 60, axiom: 'F--F--F', productions: {F: 'F+F--F+F'}},
    plant: {angle: 22.5, axiom: 'X', productions: {X: 'F-[[X]+X]+F[+FX]-X', F: 'FF'}},
    tree: {
        axiom: [module_('A', 1, 0.1)],
        productions: {
            A: ({params: [l, w]}) => [
                module_('!', w), module_('F', l), module_('['), module_('+', 30), module_('A', l * 0.8, w * 0.7),
                module_(']'), module_('-', 20), module_('A', l * 0.75, w * 0.7),
            ],
        },
    },
};

const {angle, axiom, productions} = systems[name];
const now = () => Number(process.hrtime.bigint()) / 1e9;
let x = 0, y = 0, heading = Math.PI / 2, segments = 0, least = 0, most = 0;
const branches = [];
const value = (part, otherwise) => (part.params && part.params.length ? part.params[0] : otherwise);
const turn = degrees => { heading += degrees * Math.PI / 180; };
const system = new LSystem({
    axiom,
    productions,
    finals: {
        F: ({part}) => {
            const length = value(part, 1);
            x += length * Math.cos(heading);
            y += length * Math.sin(heading);
            least = Math.min(least, x);
            most = Math.max(most, x);
            ++segments;
        },
        '+': ({part}) => turn(value(part, angle)),
        '-': ({part}) => turn(-value(part, angle)),
        '[': () => branches.push([x, y, heading]),
        ']': () => { [x, y, heading] = branches.pop(); },
    },
});

const begin = now();
system.iterate(Number(steps));
const derived = now();
system.final();
const drawn = now();
console.log(system.getRaw().length, (derived - begin).toFixed(3), (drawn - derived).toFixed(3), segments,
            (most - least).toFixed(6));
