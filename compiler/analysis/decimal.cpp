#include "compiler/analysis/decimal.h"

#include <cmath>
#include <utility>
#include <vector>

namespace graftal {

namespace {

using boost::multiprecision::cpp_int;

constexpr std::size_t least_digits = 512;

/// Writes `number` with leading zeros as `least_digits * 2^level` digits; powers[k] = 10^(least_digits 2^k).
void append(std::string& text, const cpp_int& number, std::size_t level, const std::vector<cpp_int>& powers) {
    if (level == 0) {
        const std::string digits = number.str();
        text.append(least_digits - digits.size(), '0');
        text += digits;
        return;
    }
    cpp_int high, low;
    boost::multiprecision::divide_qr(number, powers[level - 1], high, low);
    append(text, high, level - 1, powers);
    append(text, low, level - 1, powers);
}

} // namespace

std::string to_decimal(const cpp_int& number) {
    if (number == 0) return "0";
    std::vector<cpp_int> powers;
    cpp_int power = boost::multiprecision::pow(cpp_int(10), static_cast<unsigned>(least_digits));
    std::size_t level = 0;
    while (power <= number) {
        powers.push_back(power);
        power *= power;
        ++level;
    }
    std::string text;
    append(text, number, level, powers);
    return text.substr(text.find_first_not_of('0'));
}

} // namespace graftal
