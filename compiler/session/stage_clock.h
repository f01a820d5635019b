#pragma once

#include <chrono>
#include <exception>
#include <vector>

#include "compiler/session/values.h"
#include "compiler/support/check.h"

namespace graftal {

/// Runs stages and notes how long each took.
class StageClock {
  public:
    explicit StageClock(std::vector<StageTime>& times) : times_(times) {}

    /// Runs the work of a stage. A fault in it names the stage.
    template<typename Work> auto run(const char* stage, const Work& work) {
        const auto begin = std::chrono::steady_clock::now();
        try {
            auto result = work();
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - begin;
            times_.push_back({stage, elapsed.count()});
            return result;
        } catch (const std::exception&) {
            rethrow_in_stage(stage);
        }
    }

  private:
    std::vector<StageTime>& times_;
};

} // namespace graftal
