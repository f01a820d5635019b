#include "compiler/lsys/turtle/length_tally.h"

#include <algorithm>
#include <cmath>

namespace graftal {

namespace {

/// log(e^a + e^b)
double log_sum(double a, double b) {
    return std::max(a, b) + std::log1p(std::exp(-std::abs(a - b)));
}

/// The nearest quarter of an octave. Powers of two lie in the middle of theirs, so that rounding parts none
/// that are meant to be equal.
int quarter_of(double length) {
    constexpr double eighth = 1.0905077326652577; // 2^(1/8)
    constexpr double bounds[] = {0.5 * eighth * eighth * eighth,
                                 0.5 * eighth * eighth * eighth * eighth * eighth, 1 / eighth};
    int octave = 0;
    const double share = std::frexp(length, &octave);
    int quarter = 4 * octave;
    if (share < 0.5 * eighth) return quarter;
    ++quarter;
    for (const double bound : bounds)
        quarter += share >= bound ? 1 : 0;
    return quarter;
}

} // namespace

void LengthTally::add(double length) {
    const int quarter = quarter_of(length);
    if (last_ >= bins_.size() || bins_[last_].quarter != quarter) last_ = place_of(quarter);
    Bin& bin = bins_[last_];
    bin.longest = std::max(bin.longest, length);
    ++bin.count;
}

void LengthTally::add(const LengthTally& other, double scale) {
    for (const Bin& from : other.bins_) {
        const double longest = from.longest * scale;
        Bin& bin = bins_[place_of(quarter_of(longest))];
        bin.longest = std::max(bin.longest, longest);
        bin.log_more = log_sum(bin.log_more, from.log_count());
    }
}

/// The place of a quarter's bin, which is made if there is none.
std::size_t LengthTally::place_of(int quarter) {
    auto place = std::ranges::lower_bound(bins_, quarter, {}, &Bin::quarter);
    if (place == bins_.end() || place->quarter != quarter) place = bins_.insert(place, Bin{quarter});
    return static_cast<std::size_t>(place - bins_.begin());
}

double LengthTally::Bin::log_count() const {
    return count == 0 ? log_more : log_sum(log_more, std::log(static_cast<double>(count)));
}

double LengthTally::median() const {
    const auto log_weight = [](const Bin& bin) { return bin.log_count() + std::log(bin.longest); };
    double most = log_weight(bins_.front());
    for (const Bin& bin : bins_)
        most = std::max(most, log_weight(bin));
    double all = 0;
    for (const Bin& bin : bins_)
        all += std::exp(log_weight(bin) - most);
    double sum = 0;
    constexpr double rounding = 1e-9; // keeps the order of the lengths from deciding a tie
    for (const Bin& bin : bins_) {
        sum += std::exp(log_weight(bin) - most);
        if (sum >= all / 2 * (1 - rounding)) return bin.longest;
    }
    return longest();
}

} // namespace graftal
