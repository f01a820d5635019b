#include "compiler/import/flame/parametric.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <span>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "compiler/support/number.h"

namespace graftal::flame {

namespace {

/// A name and what stands for it: for the number of a variation its value where the file says none, for a
/// step its text.
struct Part {
    std::string_view name, text;
};

struct Row {
    std::string_view variation;
    std::vector<Part> numbers; ///< their names follow that of the variation in the file: `curl_c1`
    std::vector<Part> steps;   ///< used by those below and by the formulas
    std::string_view x, y;
    std::vector<Part> draws = {}; ///< random numbers, each the same wherever it is used
};

/// Steps that several variations share. `u` and `v` are the point behind the affine part, `w` is the weight,
/// `e` and `f` are the translation of the affine part, `k` is the number of the branch.
constexpr Part shared[] = {
    {"deg", "57.29577951308232"}, // our functions take degrees
    {"phi", "pi / 180 * atan2(v, u)"},
    {"sa", "sin(deg * theta)"},
    {"ca", "cos(deg * theta)"},
    {"sinu", "sin(deg * u)"},
    {"cosu", "cos(deg * u)"},
    {"sinv", "sin(deg * v)"},
    {"cosv", "cos(deg * v)"},
    {"sin2u", "sin(deg * 2*u)"},
    {"cos2u", "cos(deg * 2*u)"},
    {"sin2v", "sin(deg * 2*v)"},
    {"cos2v", "cos(deg * 2*v)"},
    {"sinhu", "(exp(u) - exp(-u)) / 2"},
    {"coshu", "(exp(u) + exp(-u)) / 2"},
    {"sinhv", "(exp(v) - exp(-v)) / 2"},
    {"coshv", "(exp(v) + exp(-v)) / 2"},
    {"sinh2u", "(exp(2*u) - exp(-2*u)) / 2"},
    {"cosh2u", "(exp(2*u) + exp(-2*u)) / 2"},
    {"sinh2v", "(exp(2*v) - exp(-2*v)) / 2"},
    {"cosh2v", "(exp(2*v) + exp(-2*v)) / 2"},
    {"xmax", "(sqrt(r2 + 1 + 2*u) + sqrt(max(0, r2 + 1 - 2*u))) / 2"},
};

// Formulas of flam3 3.1 (Draves and Reckase, appendix, has most).
const std::vector<Row>& rows() {
    // Random numbers of blurs: a turn, and a distance up to 1, or nearly normal as the sum of four.
    static const std::vector<Part> even_blur = {{"turn", "random(0, 360)"}, {"far", "random(0, 1)"}};
    static const std::vector<Part> gaussian_blur = {
        {"turn", "random(0, 360)"}, {"far", "random(0, 1) + random(0, 1) + random(0, 1) + random(0, 1) - 2"}};
    static const std::vector<Row> all = {
        {"rings", {}, {{"d", "e*e + 1e-10"}, {"n", "mod(r + d, 2*d) - d + r * (1 - d)"}}, "n * ca", "n * sa"},
        {"fan",
         {},
         {{"d", "pi * (e*e + 1e-10)"}, {"a", "theta + choose(mod(theta + f, d) > d / 2, -d / 2, d / 2)"}},
         "r * cos(deg * a)",
         "r * sin(deg * a)"},
        {"blob",
         {{"low", "0"}, {"high", "1"}, {"waves", "1"}},
         {{"n", "r * (low + (high - low) * (0.5 + 0.5 * sin(deg * waves * theta)))"}},
         "sa * n",
         "ca * n"},
        {"pdj",
         {{"a", "0"}, {"b", "0"}, {"c", "0"}, {"d", "0"}},
         {},
         "sin(deg * a * v) - cos(deg * b * u)",
         "sin(deg * c * u) - cos(deg * d * v)"},
        {"fan2",
         {{"x", "0"}, {"y", "0"}},
         {{"d", "pi * (x*x + 1e-10)"},
          {"q", "(theta + y) / d"},
          {"t", "theta + y - d * sign(q) * floor(abs(q))"},
          {"a", "theta + choose(t > d / 2, -d / 2, d / 2)"}},
         "r * sin(deg * a)",
         "r * cos(deg * a)"},
        {"rings2",
         {{"val", "0"}},
         {{"d", "val*val + 1e-10"}, {"n", "r - 2*d * floor((r + d) / (2*d)) + r * (1 - d)"}},
         "sa * n",
         "ca * n"},
        {"perspective",
         {{"angle", "0"}, {"dist", "0"}},
         {{"t", "1 / (dist - v * sin(90 * angle))"}},
         "dist * u * t",
         "dist * cos(90 * angle) * v * t"},
        {"julian",
         {{"power", "1"}, {"dist", "1"}},
         {{"a", "(phi + 2*pi * k) / power"}, {"n", "r2^(dist / power / 2)"}},
         "n * cos(deg * a)",
         "n * sin(deg * a)"},
        {"juliascope",
         {{"power", "1"}, {"dist", "1"}},
         {{"a", "(2*pi * k + choose(mod(k, 2) == 0, 1, -1) * phi) / power"}, {"n", "r2^(dist / power / 2)"}},
         "n * cos(deg * a)",
         "n * sin(deg * a)"},
        {"wedge_julia",
         {{"power", "1"}, {"dist", "0"}, {"count", "1"}, {"angle", "0"}},
         {{"b", "(phi + 2*pi * k) / power"},
          {"a", "b * (1 - angle * count / (2*pi)) + floor((count * b + pi) / (2*pi)) * angle"},
          {"n", "r2^(dist / power / 2)"}},
         "n * cos(deg * a)",
         "n * sin(deg * a)"},
        {"curl",
         {{"c1", "1"}, {"c2", "0"}},
         {{"re", "1 + c1 * u + c2 * (u*u - v*v)"}, {"im", "c1 * v + 2 * c2 * u * v"}, {"n", "re*re + im*im"}},
         "(u * re + v * im) / n",
         "(v * re - u * im) / n"},
        {"rectangles",
         {{"x", "1"}, {"y", "1"}},
         {},
         "choose(x == 0, u, (2 * floor(u / (x + (x == 0))) + 1) * x - u)",
         "choose(y == 0, v, (2 * floor(v / (y + (y == 0))) + 1) * y - v)"},
        {"secant2", {}, {{"n", "cos(deg * w * r)"}}, "u", "1 / n + choose(n < 0, 1, -1)"},
        {"disc2",
         {{"rot", "0"}, {"twist", "0"}},
         {{"t", "rot * pi * (u + v)"},
          {"n", "choose(twist > 2*pi, 1 + twist - 2*pi, choose(twist < -2*pi, 1 + twist + 2*pi, 1))"}},
         "(sin(deg * t) + n * (cos(deg * twist) - 1)) * theta / pi",
         "(cos(deg * t) + n * sin(deg * twist)) * theta / pi"},
        {"bent2", {{"x", "1"}, {"y", "1"}}, {}, "choose(u < 0, u * x, u)", "choose(v < 0, v * y, v)"},
        {"bipolar",
         {{"shift", "0"}},
         {{"b", "pi / 360 * atan2(2*v, r2 - 1) - pi / 2 * shift"},
          {"a", "choose(b > pi / 2, mod(b + pi / 2, pi) - pi / 2, choose(b < -pi / 2, pi / 2 - mod(pi / 2 - "
                "b, pi), b))"}},
         "log((r2 + 1 + 2*u) / (r2 + 1 - 2*u)) / (2*pi)",
         "2 / pi * a"},
        {"butterfly",
         {},
         {{"n", "1.3029400317411198 * sqrt(abs(u * v) / (1e-10 + u*u + 4*v*v))"}},
         "n * u",
         "n * 2*v"},
        {"cell",
         {{"size", "1"}},
         {{"i", "floor(u / size)"}, {"j", "floor(v / size)"}},
         "u - i * size + choose(i >= 0, 2*i, -2*i - 1) * size",
         "j * size - v - choose(j >= 0, 2*j, -2*j - 1) * size"},
        {"curve",
         {{"xamp", "0"}, {"yamp", "0"}, {"xlength", "1"}, {"ylength", "1"}},
         {},
         "u + xamp * exp(-v*v / max(1e-20, xlength*xlength))",
         "v + yamp * exp(-u*u / max(1e-20, ylength*ylength))"},
        {"edisc",
         {},
         {{"a", "log(xmax + sqrt(max(0, xmax - 1)))"},
          {"b", "-pi / 180 * acos(max(-1, min(1, u / xmax)))"},
          {"s", "choose(v > 0, -1, 1)"}},
         "(exp(b) + exp(-b)) / 2 * cos(deg * a) / 11.57034632",
         "(exp(b) - exp(-b)) / 2 * s * sin(deg * a) / 11.57034632"},
        {"elliptic",
         {},
         {{"a", "u / xmax"}},
         "atan2(a, sqrt(max(0, 1 - a*a))) / 90",
         "choose(v > 0, 1, -1) * 2 / pi * log(xmax + sqrt(max(0, xmax - 1)))"},
        {"escher",
         {{"beta", "0"}},
         {{"c", "0.5 * (1 + cos(deg * beta))"},
          {"d", "0.5 * sin(deg * beta)"},
          {"m", "exp(c * log(r2) / 2 - d * phi)"},
          {"n", "c * phi + d * log(r2) / 2"}},
         "m * cos(deg * n)",
         "m * sin(deg * n)"},
        {"foci", {}, {{"n", "coshu - cosv"}}, "sinhu / n", "sinv / n"},
        {"lazysusan",
         {{"space", "0"}, {"twist", "0"}, {"spin", "0"}, {"x", "0"}, {"y", "0"}},
         {{"p", "u - x"},
          {"q", "v + y"},
          {"d", "sqrt(p*p + q*q)"},
          {"a", "pi / 180 * atan2(q, p) + spin + twist * (w - d)"},
          {"n", "1 + space / d"}},
         "choose(d < w, d * cos(deg * a), n * p) + x / w",
         "choose(d < w, d * sin(deg * a), n * q) - y / w"},
        {"loonie", {}, {{"n", "choose(r2 < w*w, sqrt(max(0, w*w / r2 - 1)), 1)"}}, "n * u", "n * v"},
        {"modulus",
         {{"x", "0"}, {"y", "0"}},
         {{"a", "2*x + (x == 0)"}, {"b", "2*y + (y == 0)"}},
         "choose(u > x, mod(u + x, a) - x, choose(u < -x, x - mod(x - u, a), u))",
         "choose(v > y, mod(v + y, b) - y, choose(v < -y, y - mod(y - v, b), v))"},
        {"oscilloscope",
         {{"separation", "1"}, {"frequency", "3.141592653589793"}, {"amplitude", "1"}, {"damping", "0"}},
         {{"t", "amplitude * exp(-abs(u) * damping) * cos(360 * frequency * u) + separation"}},
         "u",
         "choose(abs(v) <= t, -v, v)"},
        {"polar2", {}, {}, "theta / pi", "log(r2) / (2*pi)"},
        {"popcorn2",
         {{"c", "0"}, {"x", "0"}, {"y", "0"}},
         {},
         "u + x * sin(deg * tan(deg * v * c))",
         "v + y * sin(deg * tan(deg * u * c))"},
        {"scry", {}, {{"n", "w * r * (r2 + 1 / (w + 1e-10))"}}, "u / n", "v / n"},
        {"separation",
         {{"x", "0"}, {"xinside", "0"}, {"y", "0"}, {"yinside", "0"}},
         {},
         "choose(u > 0, 1, -1) * sqrt(u*u + x*x) - u * xinside",
         "choose(v > 0, 1, -1) * sqrt(v*v + y*y) - v * yinside"},
        {"split",
         {{"xsize", "0"}, {"ysize", "0"}},
         {},
         "choose(cos(180 * v * ysize) >= 0, u, -u)",
         "choose(cos(180 * u * xsize) >= 0, v, -v)"},
        {"splits", {{"x", "0"}, {"y", "0"}}, {}, "u + choose(u >= 0, x, -x)", "v + choose(v >= 0, y, -y)"},
        {"stripes",
         {{"space", "0"}, {"warp", "0"}},
         {{"i", "floor(u + 0.5)"}, {"d", "u - i"}},
         "d * (1 - space) + i",
         "v + d*d * warp"},
        {"wedge",
         {{"angle", "0"}, {"hole", "0"}, {"count", "1"}, {"swirl", "0"}},
         {{"b", "phi + swirl * r"},
          {"a", "b * (1 - angle * count / (2*pi)) + floor((count * b + pi) / (2*pi)) * angle"}},
         "(r + hole) * cos(deg * a)",
         "(r + hole) * sin(deg * a)"},
        {"wedge_sph",
         {{"angle", "0"}, {"hole", "0"}, {"count", "1"}, {"swirl", "0"}},
         {{"d", "1 / (r + 1e-10)"},
          {"b", "phi + swirl * d"},
          {"a", "b * (1 - angle * count / (2*pi)) + floor((count * b + pi) / (2*pi)) * angle"}},
         "(d + hole) * cos(deg * a)",
         "(d + hole) * sin(deg * a)"},
        {"whorl",
         {{"inside", "0"}, {"outside", "0"}},
         {{"a", "phi + choose(r < w, inside, outside) / (w - r)"}},
         "r * cos(deg * a)",
         "r * sin(deg * a)"},
        {"waves2",
         {{"scalex", "0"}, {"scaley", "0"}, {"freqx", "0"}, {"freqy", "0"}},
         {},
         "u + scalex * sin(deg * v * freqx)",
         "v + scaley * sin(deg * u * freqy)"},
        {"exp", {}, {}, "exp(u) * cosv", "exp(u) * sinv"},
        {"log", {}, {}, "log(r2) / 2", "phi"},
        {"sin", {}, {}, "sinu * coshv", "cosu * sinhv"},
        {"cos", {}, {}, "cosu * coshv", "-sinu * sinhv"},
        {"tan", {}, {{"n", "cos2u + cosh2v"}}, "sin2u / n", "sinh2v / n"},
        {"sec", {}, {{"n", "2 / (cos2u + cosh2v)"}}, "n * cosu * coshv", "n * sinu * sinhv"},
        {"csc", {}, {{"n", "2 / (cosh2v - cos2u)"}}, "n * sinu * coshv", "-n * cosu * sinhv"},
        {"cot", {}, {{"n", "cosh2v - cos2u"}}, "sin2u / n", "-sinh2v / n"},
        {"sinh", {}, {}, "sinhu * cosv", "coshu * sinv"},
        {"cosh", {}, {}, "coshu * cosv", "sinhu * sinv"},
        {"tanh", {}, {{"n", "cos2v + cosh2u"}}, "sinh2u / n", "sin2v / n"},
        {"sech", {}, {{"n", "2 / (cos2v + cosh2u)"}}, "n * cosv * coshu", "-n * sinv * sinhu"},
        {"csch", {}, {{"n", "2 / (cosh2u - cos2v)"}}, "n * sinhu * cosv", "-n * coshu * sinv"},
        {"coth", {}, {{"n", "cosh2u - cos2v"}}, "sinh2u / n", "sin2v / n"},
        {"auger",
         {{"sym", "0"}, {"weight", "0.5"}, {"freq", "1"}, {"scale", "1"}},
         {{"s", "sin(deg * freq * u)"}, {"t", "sin(deg * freq * v)"}},
         "u + sym * weight * (scale * t / 2 + abs(u) * t)",
         "v + weight * (scale * s / 2 + abs(v) * s)"},
        {"flux",
         {{"spread", "0"}},
         {{"p", "u + w"},
          {"m", "u - w"},
          {"n", "(2 + spread) * sqrt(sqrt(v*v + p*p) / sqrt(v*v + m*m))"},
          {"a", "(atan2(v, m) - atan2(v, p)) / 2"}},
         "n * cos(a)",
         "n * sin(a)"},
        {"mobius",
         {{"re_a", "0"},
          {"im_a", "0"},
          {"re_b", "0"},
          {"im_b", "0"},
          {"re_c", "0"},
          {"im_c", "0"},
          {"re_d", "0"},
          {"im_d", "0"}},
         {{"a", "re_a * u - im_a * v + re_b"},
          {"b", "re_a * v + im_a * u + im_b"},
          {"c", "re_c * u - im_c * v + re_d"},
          {"d", "re_c * v + im_c * u + im_d"},
          {"n", "c*c + d*d"}},
         "(a * c + b * d) / n",
         "(b * c - a * d) / n"},
        {"ngon",
         {{"sides", "5"}, {"power", "3"}, {"circle", "1"}, {"corners", "2"}},
         {{"b", "2*pi / sides"},
          {"t", "phi - b * floor(phi / b)"},
          {"a", "choose(t > b / 2, t - b, t)"},
          {"n", "(corners * (1 / (cos(deg * a) + 1e-10) - 1) + circle) / (r2^(power / 2) + 1e-10)"}},
         "n * u",
         "n * v"},
        {"blur", {}, {}, "far * cos(turn)", "far * sin(turn)", even_blur},
        {"noise", {}, {}, "u * far * cos(turn)", "v * far * sin(turn)", even_blur},
        {"gaussian_blur", {}, {}, "far * cos(turn)", "far * sin(turn)", gaussian_blur},
        {"pre_blur", {}, {}, "far * cos(turn)", "far * sin(turn)", gaussian_blur},
        {"pre_gaussian_blur", {}, {}, "far * cos(turn)", "far * sin(turn)", gaussian_blur},
        {"sineblur",
         {},
         {},
         "far * cos(turn)",
         "far * sin(turn)",
         {{"turn", "random(0, 360)"}, {"far", "acos(random(-1, 1)) / 180"}}},
        {"square", {}, {}, "across", "up", {{"across", "random(-1/2, 1/2)"}, {"up", "random(-1/2, 1/2)"}}},
        {"pie",
         {{"slices", "6"}, {"rotation", "0"}, {"thickness", "0.5"}},
         {{"a", "rotation + 2*pi * (floor(slice + 0.5) + thickness * part) / slices"}},
         "far * cos(deg * a)",
         "far * sin(deg * a)",
         {{"slice", "random(0, slices)"}, {"part", "random(0, 1)"}, {"far", "random(0, 1)"}}},
        {"radial_blur",
         {{"angle", "0"}},
         {{"a", "phi + sin(90 * angle) * w * gauss"}, {"n", "cos(90 * angle) * w * gauss - 1"}},
         "(r * cos(deg * a) + n * u) / w",
         "(r * sin(deg * a) + n * v) / w",
         {{"gauss", "random(0, 1) + random(0, 1) + random(0, 1) + random(0, 1) - 2"}}},
        {"arch",
         {},
         {{"s", "sin(deg * w * turn)"}},
         "s",
         "s*s / cos(deg * w * turn)",
         {{"turn", "random(0, pi)"}}},
        {"rays",
         {},
         {{"n", "w * tan(deg * w * turn) / (r2 + 1e-10)"}},
         "n * cosu",
         "n * sinv",
         {{"turn", "random(0, pi)"}}},
        {"blade",
         {},
         {{"s", "sin(deg * w * r * far)"}, {"c", "cos(deg * w * r * far)"}},
         "u * (c + s)",
         "u * (c - s)",
         {{"far", "random(0, 1)"}}},
        {"twintrian",
         {},
         {{"s", "sin(deg * w * r * far)"},
          {"n", "max(-30, log(max(1e-30, s*s)) / 2.302585092994046 + cos(deg * w * r * far))"}},
         "u * n",
         "u * (n - pi * s)",
         {{"far", "random(0, 1)"}}},
        {"flower",
         {{"holes", "0"}, {"petals", "0"}},
         {{"n", "(far - holes) * cos(deg * petals * phi) / (r + 1e-10)"}},
         "n * u",
         "n * v",
         {{"far", "random(0, 1)"}}},
        {"conic",
         {{"eccentricity", "1"}, {"holes", "0"}},
         {{"n", "(far - holes) * eccentricity / (r + eccentricity * u + 1e-10)"}},
         "n * u",
         "n * v",
         {{"far", "random(0, 1)"}}},
        {"parabola",
         {{"width", "0"}, {"height", "0"}},
         {{"s", "sin(deg * r)"}},
         "height * s*s * high",
         "width * cos(deg * r) * wide",
         {{"high", "random(0, 1)"}, {"wide", "random(0, 1)"}}},
        {"cpow",
         {{"r", "1"}, {"i", "0"}, {"power", "1"}},
         {{"a", "(r * phi + i * log(r2) / 2 + 2*pi * floor(turn)) / power"},
          {"n", "exp((r * log(r2) / 2 - i * phi) / power)"}},
         "n * cos(deg * a)",
         "n * sin(deg * a)",
         {{"turn", "random(0, power)"}}},
        {"super_shape",
         {{"m", "0"}, {"n1", "1"}, {"n2", "1"}, {"n3", "1"}, {"rnd", "0"}, {"holes", "0"}},
         {{"t", "m / 4 * phi + pi / 4"},
          {"c", "abs(cos(deg * t))^n2 + abs(sin(deg * t))^n3"},
          {"n", "(rnd * far + (1 - rnd) * r - holes) * c^(-1 / n1) / (r + 1e-10)"}},
         "n * u",
         "n * v",
         {{"far", "random(0, 1)"}}},
        {"boarders",
         {},
         {{"i", "floor(u + 0.5)"},
          {"j", "floor(v + 0.5)"},
          {"d", "u - i"},
          {"h", "v - j"},
          {"a", "choose(d >= 0, 1/4, -1/4)"},
          {"b", "choose(h >= 0, 1/4, -1/4)"}},
         "i + d / 2 + choose(far >= 3/4, 0, choose(abs(d) >= abs(h), a, b * d / (h + (h == 0))))",
         "j + h / 2 + choose(far >= 3/4, 0, choose(abs(d) >= abs(h), a * h / (d + (d == 0)), b))",
         {{"far", "random(0, 1)"}}},
        // JWildfire's formulas, in the plane.
        {"twoface", {}, {{"n", "choose(u > 0, 1 / (r2 + 1e-10), 1)"}}, "n * u", "n * v"},
        {"funnel",
         {{"effect", "8"}},
         {},
         "sinhu / coshu * (1 / cosu + effect * pi)",
         "sinhv / coshv * (1 / cosv + effect * pi)"},
        {"epispiral",
         {{"n", "6"}, {"thickness", "0"}, {"holes", "1"}},
         {{"m", "choose(thickness == 0, 1, thickness * far) / cos(deg * n * phi) - holes"}},
         "m * cos(deg * phi)",
         "m * sin(deg * phi)",
         {{"far", "random(0, 1)"}}},
        {"spherical3D", {}, {}, "u / (r2 + 1e-10)", "v / (r2 + 1e-10)"},
        {"petal", {}, {}, "cosu * (cosu * cosv)^3", "cosu * (sinu * cosv)^3"},
        {"henon", {{"a", "0.5"}, {"b", "1"}, {"c", "1"}}, {}, "c - a * u*u + v", "b * u"},
        {"lozi", {{"a", "0.5"}, {"b", "1"}, {"c", "1"}}, {}, "c - a * abs(u) + v", "b * u"},
        {"clifford_js",
         {{"a", "0"}, {"b", "1.6"}, {"c", "1"}, {"d", "0.7"}},
         {},
         "sin(deg * a * v) + c * cos(deg * a * u)",
         "sin(deg * b * u) + d * cos(deg * b * v)"},
    };
    return all;
}

const Row* row_of(std::string_view variation) {
    const auto found = std::ranges::find(rows(), variation, &Row::variation);
    return found == rows().end() ? nullptr : &*found;
}

/// Writes a text with what its names stand for.
class Text {
  public:
    Text(const Row& row, const Setting& setting, int branch) : row_(row) {
        for (const Part& number : row.numbers)
            set(number.name, setting.number(fmt::format("{}_{}", row.variation, number.name),
                                            parse_number(number.text).value_or(0)));
        set("w", setting.weight);
        set("e", setting.pre.translation.x);
        set("f", setting.pre.translation.y);
        set("k", branch);
    }

    std::string of(std::string_view text) const {
        std::string out;
        for (std::size_t at = 0; at < text.size();) {
            std::size_t end = at;
            while (end < text.size() &&
                   (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
                ++end;
            if (end == at) {
                out += text[at++];
                continue;
            }
            const std::string_view word = text.substr(at, end - at);
            out += end < text.size() && text[end] == '(' ? std::string(word) : meaning(word);
            at = end;
        }
        return out;
    }

  private:
    void set(std::string_view name, double value) {
        values_.emplace(name, value < 0 ? fmt::format("({})", shortest(value)) : shortest(value));
    }

    std::string meaning(std::string_view word) const {
        const auto in = [&](std::span<const Part> steps) {
            const auto found = std::ranges::find(steps, word, &Part::name);
            return found == steps.end() ? std::string() : fmt::format("({})", of(found->text));
        };
        if (std::ranges::find(row_.draws, word, &Part::name) != row_.draws.end())
            return std::string(word) + "#"; // Formula::draws
        if (std::string step = in(row_.steps); !step.empty()) return step;
        if (const auto value = values_.find(word); value != values_.end()) return value->second;
        if (std::string step = in(shared); !step.empty()) return word == "deg" ? "57.29577951308232" : step;
        return std::string(word);
    }

    const Row& row_;
    std::map<std::string_view, std::string> values_;
};

} // namespace

bool is_parametric(std::string_view variation) {
    return row_of(variation) != nullptr;
}

std::vector<Formula> parametric_formulas(std::string_view variation, const Setting& setting) {
    const Row* const row = row_of(variation);
    if (!row) return {};
    int branches = 1;
    if (variation == "julian" || variation == "juliascope" || variation == "wedge_julia") {
        // Each root is as likely as the others; a broken number of them is not.
        const double power = std::abs(setting.number(fmt::format("{}_power", variation), 1));
        if (!(power >= 1 && power <= most_branches) || power != std::floor(power)) return {};
        branches = static_cast<int>(power);
    }
    std::vector<Formula> formulas;
    for (int branch = 0; branch < branches; ++branch) {
        const Text text(*row, setting, branch);
        std::string draws;
        for (const Part& draw : row->draws)
            draws += fmt::format("{}{}# = {}", draws.empty() ? "" : ", ", draw.name, text.of(draw.text));
        formulas.push_back({text.of(row->x), text.of(row->y), draws});
    }
    return formulas;
}

} // namespace graftal::flame
