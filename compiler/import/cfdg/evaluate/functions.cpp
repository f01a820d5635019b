#include "compiler/import/cfdg/evaluate/functions.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace graftal::cfdg {

namespace {

constexpr double one_degree = std::numbers::pi / 180;

/// Exact at multiples of 90 degrees.
double sine(double degrees) {
    const double turns = std::fmod(degrees, 360);
    if (turns == 0 || std::abs(turns) == 180) return 0;
    return std::sin(turns * one_degree);
}

double not_in_52_bits(double x) {
    if (!(x >= 0 && x < 0x1p52)) return std::nan("");
    return static_cast<double>(~static_cast<std::uint64_t>(x) & 0xfffffffffffffULL);
}

} // namespace

const std::map<std::string, double (*)(double)>& plain_functions() {
    static const std::map<std::string, double (*)(double)> table = {
        {"sin", sine},
        {"cos", [](double x) { return sine(x + 90); }},
        {"tan", [](double x) { return std::tan(x * one_degree); }},
        {"cot", [](double x) { return 1 / std::tan(x * one_degree); }},
        {"asin", [](double x) { return std::asin(x) / one_degree; }},
        {"acos", [](double x) { return std::acos(x) / one_degree; }},
        {"atan", [](double x) { return std::atan(x) / one_degree; }},
        {"acot", [](double x) { return std::atan(1 / x) / one_degree; }},
        {"sinh", [](double x) { return std::sinh(x); }},
        {"cosh", [](double x) { return std::cosh(x); }},
        {"tanh", [](double x) { return std::tanh(x); }},
        {"asinh", [](double x) { return std::asinh(x); }},
        {"acosh", [](double x) { return std::acosh(x); }},
        {"atanh", [](double x) { return std::atanh(x); }},
        {"sqrt", [](double x) { return std::sqrt(x); }},
        {"exp", [](double x) { return std::exp(x); }},
        {"log", [](double x) { return std::log(x); }},
        {"log10", [](double x) { return std::log10(x); }},
        {"floor", [](double x) { return std::floor(x); }},
        {"ceiling", [](double x) { return std::ceil(x); }},
        {"abs", [](double x) { return std::abs(x); }},
        {"sg", [](double x) { return x == 0 ? 0.0 : 1.0; }},
        {"bitnot", not_in_52_bits},
    };
    return table;
}

double binary(const std::string& sign, double a, double b) {
    if (sign == "+") return a + b;
    if (sign == "-") return a - b;
    if (sign == "*") return a * b;
    if (sign == "/") return a / b;
    if (sign == "^") return std::pow(a, b);
    if (sign == "_") return std::max(0.0, a - b);
    if (sign == "<") return a < b;
    if (sign == "<=") return a <= b;
    if (sign == ">") return a > b;
    if (sign == ">=") return a >= b;
    if (sign == "==") return a == b;
    if (sign == "<>") return a != b;
    if (sign == "&&") return a != 0 && b != 0;
    if (sign == "||") return a != 0 || b != 0;
    return (a != 0) != (b != 0);
}

} // namespace graftal::cfdg
