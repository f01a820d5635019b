#include "compiler/import/own_words.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "compiler/graph/primitive.h"
#include "compiler/import/foreign_text.h"

namespace graftal {

namespace {

#define GRAFTAL_WORD(name, form) #name " "
constexpr std::string_view primitive_words = " " GRAFTAL_PRIMITIVE_KINDS(GRAFTAL_WORD);
#undef GRAFTAL_WORD

constexpr std::string_view more_words =
    " "
    "union intersection difference instance terminal scatter below object canonical repeat hue ink "
    "when else nothing tint material chance scale rotate translate shear matrix projection use let "
    "inner camera light sky haze film background ground steps count over except by apart seed turn "
    "lean size weights weight x y z n pi rgb hsv to saturation value alpha sin cos tan asin acos atan "
    "atan2 sqrt exp log floor ceil abs sign min max mod pow lerp smooth logistic random normal left ";

} // namespace

bool is_own_word(std::string_view word) {
    const std::string whole = fmt::format(" {} ", word);
    return primitive_words.find(whole) != std::string_view::npos ||
           more_words.find(whole) != std::string_view::npos;
}

std::string own_name(std::string_view wanted, std::string_view suffix) {
    std::string name = plain_name(wanted);
    if (is_own_word(name)) name += suffix;
    return name;
}

std::string free_own_name(std::string_view wanted, std::string_view suffix, std::set<std::string>& taken) {
    const std::string name = own_name(wanted, suffix);
    std::string free = name;
    for (std::size_t i = 2; !taken.insert(free).second; ++i) {
        if (i == 50) i = std::max(i, taken.size()); // a file of one name only must not take long
        free = fmt::format("{}_{}", name, i);
    }
    return free;
}

} // namespace graftal
