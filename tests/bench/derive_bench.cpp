// Modules derived a second, on one core: those of the last word by the time of all steps.

#include <string>

#include <benchmark/benchmark.h>

#include "tests/unit/lsys/words.h"

namespace graftal {
namespace {

void derive(benchmark::State& state, const std::string& statements) {
    std::size_t modules = 0;
    std::size_t distinct = 0;
    for (auto _ : state) {
        state.PauseTiming();
        testing::LsysModel model(statements);
        state.ResumeTiming();
        const auto word = model.derive(static_cast<unsigned>(state.range(0)), 1, 200'000'000);
        if (!word) return state.SkipWithError(model.errors().c_str());
        state.PauseTiming();
        modules = word->size();
        distinct = model.distinct_modules();
        state.ResumeTiming();
    }
    state.counters["word"] = static_cast<double>(modules);
    state.counters["distinct"] = static_cast<double>(distinct);
    state.SetItemsProcessed(static_cast<std::int64_t>(modules) * state.iterations());
}

BENCHMARK_CAPTURE(derive, koch, "axiom F--F--F\nF -> F+F--F+F")
    ->Arg(4)
    ->Arg(11)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, plant_1_24f, "axiom X\nX -> F-[[X]+X]+F[+FX]-X\nF -> FF")
    ->Arg(5)
    ->Arg(11)
    ->Arg(12)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, tree, R"(modules A
axiom A(1,0.1)
A(l,w) -> !(w)F(l)[+(30)A(l*0.8,w*0.7)]-(20)A(l*0.75,w*0.7))")
    ->Arg(10)
    ->DenseRange(20, 23)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, monopodial_2_6, R"(let r1 = 0.9, r2 = 0.6, a0 = 45, a2 = 45, d = 137.5, wr = 0.707
modules A B C
axiom A(1, 10)
A(l,w) -> !(w)F(l)[&(a0)B(l*r2,w*wr)]/(d)A(l*r1,w*wr)
B(l,w) -> !(w)F(l)[-(a2)$C(l*r2,w*wr)]C(l*r1,w*wr)
C(l,w) -> !(w)F(l)[+(a2)$B(l*r2,w*wr)]B(l*r1,w*wr))")
    ->Arg(10)
    ->Arg(21)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, all_distinct, "modules A\naxiom A(1)\nA(x) -> A(2*x)F(x)A(2*x+1)")
    ->Arg(19)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, stochastic_1_27,
                  "axiom F\nF -> F[+F]F[-F]F : 0.33\nF -> F[+F]F : 0.33\nF -> F[-F]F : 0.34")
    ->Arg(11)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, contexts_1_31b, R"(ignore + - F
axiom F1F1F1
0 < 0 > 0 -> 1
0 < 0 > 1 -> 1[-F1F1]
0 < 1 > 0 -> 1
0 < 1 > 1 -> 1
1 < 0 > 0 -> 0
1 < 0 > 1 -> 1F1
1 < 1 > 0 -> 1
1 < 1 > 1 -> 0
+ -> -
- -> +)")
    ->Arg(30)
    ->Arg(40)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, parametric_context, R"(modules A B
axiom A(1)B(1)B(1)B(1)
A(x) > B(y) : x < 4 -> A(x+1)B(1)B(2)
A(x) : x >= 4 -> A(1)
B(x) < B(y) > B(z) -> B((x+y+z)%7)B(y)
B(y) : y > 6 -> B(1))")
    ->Arg(20)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(derive, signal, R"(ignore + -
modules a b
axiom b[+a[-a]a]aa[-a]
b < a -> b[-a]a
b -> a)")
    ->Arg(24)
    ->Unit(benchmark::kMillisecond);

} // namespace
} // namespace graftal
