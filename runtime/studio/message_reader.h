#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include <nlohmann/json.hpp>

#include "compiler/support/affine.h"

namespace graftal {

/// A message that is not as docs/studio.md says. Caught where messages are heard.
class BadMessage : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Reads the fields of a JSON object. `null` and nothing mean the same. Throws BadMessage for fields of
/// another kind. Keeps a reference.
class MessageReader {
  public:
    /// Throws BadMessage for what is no object.
    explicit MessageReader(const nlohmann::json& object);

    std::optional<std::string> text(const char* field) const;
    std::optional<double> number(const char* field) const;
    std::optional<std::uint64_t> whole(const char* field, std::uint64_t most) const;
    std::optional<bool> flag(const char* field) const;
    std::optional<Vec3> vector(const char* field) const;
    /// Null where the field is not there.
    const nlohmann::json* object(const char* field) const;

    std::string needed_text(const char* field) const;
    double needed_number(const char* field) const;
    std::uint64_t needed_whole(const char* field, std::uint64_t most) const;

  private:
    const nlohmann::json* find(const char* field) const;

    const nlohmann::json& object_;
};

} // namespace graftal
