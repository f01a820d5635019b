#include "runtime/studio/message_reader.h"

#include <cmath>

#include <fmt/format.h>

namespace graftal {

namespace {

[[noreturn]] void refuse(const char* field, const char* wanted) {
    throw BadMessage(fmt::format("'{}' is not {}", field, wanted));
}

/// The value, or a complaint that there is none.
template<typename Value> Value needed(std::optional<Value> value, const char* field) {
    if (!value) throw BadMessage(fmt::format("'{}' is missing", field));
    return *std::move(value);
}

} // namespace

MessageReader::MessageReader(const nlohmann::json& object) : object_(object) {
    if (!object.is_object()) throw BadMessage("a message is not an object");
}

const nlohmann::json* MessageReader::find(const char* field) const {
    const auto found = object_.find(field);
    return found == object_.end() || found->is_null() ? nullptr : &*found;
}

std::optional<std::string> MessageReader::text(const char* field) const {
    const nlohmann::json* const value = find(field);
    if (!value) return std::nullopt;
    if (!value->is_string()) refuse(field, "a text");
    return value->get<std::string>();
}

std::optional<double> MessageReader::number(const char* field) const {
    const nlohmann::json* const value = find(field);
    if (!value) return std::nullopt;
    if (!value->is_number() || !std::isfinite(value->get<double>())) refuse(field, "a number");
    return value->get<double>();
}

std::optional<std::uint64_t> MessageReader::whole(const char* field, std::uint64_t most) const {
    const nlohmann::json* const value = find(field);
    if (!value) return std::nullopt;
    // A page's numbers are doubles: 3.0 is 3.
    if (value->is_number_unsigned() && value->get<std::uint64_t>() <= most)
        return value->get<std::uint64_t>();
    constexpr double largest = 9007199254740992; // 2^53
    const std::optional<double> real = number(field);
    if (!(*real >= 0 && *real <= largest && *real <= static_cast<double>(most) && *real == std::floor(*real)))
        throw BadMessage(fmt::format("'{}' is not a whole number from 0 to {}", field, most));
    return static_cast<std::uint64_t>(*real);
}

std::optional<bool> MessageReader::flag(const char* field) const {
    const nlohmann::json* const value = find(field);
    if (!value) return std::nullopt;
    if (!value->is_boolean()) refuse(field, "true or false");
    return value->get<bool>();
}

std::optional<Vec3> MessageReader::vector(const char* field) const {
    const nlohmann::json* const value = find(field);
    if (!value) return std::nullopt;
    constexpr const char* wanted = "a list of three numbers";
    if (!value->is_array() || value->size() != 3) refuse(field, wanted);
    Vec3 vector;
    for (int i = 0; i < 3; ++i) {
        const nlohmann::json& part = (*value)[static_cast<std::size_t>(i)];
        if (!part.is_number() || !std::isfinite(part.get<double>())) refuse(field, wanted);
        vector[i] = part.get<double>();
    }
    return vector;
}

const nlohmann::json* MessageReader::object(const char* field) const {
    const nlohmann::json* const value = find(field);
    if (value && !value->is_object()) refuse(field, "an object");
    return value;
}

std::string MessageReader::needed_text(const char* field) const {
    return needed(text(field), field);
}

double MessageReader::needed_number(const char* field) const {
    return needed(number(field), field);
}

std::uint64_t MessageReader::needed_whole(const char* field, std::uint64_t most) const {
    return needed(whole(field, most), field);
}

} // namespace graftal
