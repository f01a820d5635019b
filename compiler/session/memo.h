#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "compiler/support/diagnostics.h"

namespace graftal {

/// The last run of a stage: its inputs, its value, and the findings of this stage and of all before it. `Key`
/// compares inputs; nothing is kept of a run that throws.
template<typename Key, typename Value> class Memo {
  public:
    /// Numbers runs with different inputs: an input of the stage after this one.
    std::uint64_t serial() const { return serial_; }
    bool failed() const { return failed_; }
    const Diagnostics& findings() const { return findings_; }
    /// Null where the stage failed, and after drop().
    const std::shared_ptr<Value>& value() const { return value_; }
    void drop() { value_.reset(); }

    /// Whether the last run had these inputs and, if its value is `wanted`, that is still there.
    bool is_of(const Key& key, bool wanted = true) const {
        return key_ == key && (value_ || failed_ || !wanted);
    }

    /// Runs the stage: make(key, findings) gives the value, or nothing if the stage fails, and may take out
    /// of the key what it has not read. `findings`: of the stages before.
    template<typename Make> void run(Key key, Diagnostics findings, const Make& make) {
        if (!(key_ == key)) ++serial_;
        key_.reset();
        value_.reset();
        failed_ = false;
        findings_ = Diagnostics();
        std::optional<Value> value = make(key, findings);
        if (value) value_ = std::make_shared<Value>(std::move(*value));
        failed_ = !value_;
        findings_ = std::move(findings);
        key_ = std::move(key);
    }

  private:
    std::optional<Key> key_;
    std::uint64_t serial_ = 0;
    std::shared_ptr<Value> value_;
    bool failed_ = false;
    Diagnostics findings_;
};

} // namespace graftal
