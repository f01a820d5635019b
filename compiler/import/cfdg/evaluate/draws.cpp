#include "compiler/import/cfdg/evaluate/draws.h"

#include <cmath>
#include <cstddef>
#include <map>
#include <vector>

#include <boost/random/bernoulli_distribution.hpp>
#include <boost/random/binomial_distribution.hpp>
#include <boost/random/cauchy_distribution.hpp>
#include <boost/random/chi_squared_distribution.hpp>
#include <boost/random/discrete_distribution.hpp>
#include <boost/random/exponential_distribution.hpp>
#include <boost/random/extreme_value_distribution.hpp>
#include <boost/random/fisher_f_distribution.hpp>
#include <boost/random/gamma_distribution.hpp>
#include <boost/random/geometric_distribution.hpp>
#include <boost/random/lognormal_distribution.hpp>
#include <boost/random/negative_binomial_distribution.hpp>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/poisson_distribution.hpp>
#include <boost/random/student_t_distribution.hpp>
#include <boost/random/weibull_distribution.hpp>

namespace graftal::cfdg {

namespace {

/// Counts above this are hostile: some distributions take a time that grows with them.
constexpr double most_number = 1e6;

struct Distribution {
    std::size_t numbers;
    bool (*takes)(double a, double b);
    double (*draw)(Draws& draws, double a, double b);
};

bool positive(double a, double b) {
    return a > 0 && b > 0 && a <= most_number && b <= most_number;
}

bool first_positive(double a, double) {
    return a > 0 && a <= most_number;
}

bool second_positive(double a, double b) {
    return std::abs(a) <= most_number && b > 0 && b <= most_number;
}

bool is_chance(double a, double) {
    return a > 0 && a < 1;
}

bool count_and_chance(double a, double b) {
    return a >= 1 && a <= most_number && b > 0 && b < 1;
}

const std::map<std::string_view, Distribution>& distributions() {
    using namespace boost::random;
    static const std::map<std::string_view, Distribution> rows = {
        {"rand::exponential",
         {1, first_positive, [](Draws& d, double a, double) { return exponential_distribution<>(a)(d); }}},
        {"rand::gamma",
         {2, positive, [](Draws& d, double a, double b) { return gamma_distribution<>(a, b)(d); }}},
        {"rand::weibull",
         {2, positive, [](Draws& d, double a, double b) { return weibull_distribution<>(a, b)(d); }}},
        {"rand::extremeV",
         {2, second_positive,
          [](Draws& d, double a, double b) { return extreme_value_distribution<>(a, b)(d); }}},
        {"rand::normal",
         {2, second_positive, [](Draws& d, double a, double b) { return normal_distribution<>(a, b)(d); }}},
        {"rand::lognormal",
         {2, second_positive,
          [](Draws& d, double a, double b) { return lognormal_distribution<>(a, b)(d); }}},
        {"rand::chisquared",
         {1, first_positive, [](Draws& d, double a, double) { return chi_squared_distribution<>(a)(d); }}},
        {"rand::cauchy",
         {2, second_positive, [](Draws& d, double a, double b) { return cauchy_distribution<>(a, b)(d); }}},
        {"rand::fisherF",
         {2, positive, [](Draws& d, double a, double b) { return fisher_f_distribution<>(a, b)(d); }}},
        {"rand::studentT",
         {1, first_positive, [](Draws& d, double a, double) { return student_t_distribution<>(a)(d); }}},
        {"randint::bernoulli",
         {1, [](double a, double) { return a >= 0 && a <= 1; },
          [](Draws& d, double a, double) { return bernoulli_distribution<>(a)(d) ? 1.0 : 0.0; }}},
        {"randint::binomial",
         {2, count_and_chance,
          [](Draws& d, double a, double b) {
              return static_cast<double>(binomial_distribution<>(static_cast<int>(a), b)(d));
          }}},
        {"randint::negbinomial",
         {2, count_and_chance,
          [](Draws& d, double a, double b) {
              return static_cast<double>(negative_binomial_distribution<>(static_cast<int>(a), b)(d));
          }}},
        {"randint::poisson",
         {1, first_positive,
          [](Draws& d, double a, double) { return static_cast<double>(poisson_distribution<>(a)(d)); }}},
        {"randint::geometric", {1, is_chance, [](Draws& d, double a, double) {
                                    return static_cast<double>(geometric_distribution<>(a)(d));
                                }}}};
    return rows;
}

} // namespace

std::optional<double> Draws::distribution(std::string_view name, std::span<const double> numbers) {
    if (name == "randint::discrete") {
        double sum = 0;
        for (const double weight : numbers)
            sum += weight >= 0 ? weight : std::nan("");
        if (numbers.empty() || !(sum > 0)) return std::nullopt;
        const std::vector<double> weights(numbers.begin(), numbers.end());
        return static_cast<double>(boost::random::discrete_distribution<>(weights)(*this));
    }
    const auto row = distributions().find(name);
    if (row == distributions().end() || numbers.size() != row->second.numbers) return std::nullopt;
    const double a = numbers[0], b = numbers.size() > 1 ? numbers[1] : 0;
    if (!row->second.takes(a, b)) return std::nullopt;
    const double value = row->second.draw(*this, a, b);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

} // namespace graftal::cfdg
