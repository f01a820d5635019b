#pragma once

#include <string>
#include <utility>

namespace graftal {

/// The outcome of a step that depends on the environment (files, child processes). An empty message is
/// success; else it says what was tried and what the system answered. Such failures exit with status 3.
class [[nodiscard]] Status {
  public:
    Status() = default;
    static Status failure(std::string message) { return Status(std::move(message)); }

    bool ok() const { return message_.empty(); }
    const std::string& message() const { return message_; }

  private:
    explicit Status(std::string message) : message_(std::move(message)) {}

    std::string message_;
};

} // namespace graftal
