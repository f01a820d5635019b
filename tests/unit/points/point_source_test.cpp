#include "runtime/points/point_source.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "compiler/languages/lower.h"
#include "runtime/points/orbit_source.h"

namespace graftal {
namespace {

TEST(OrbitSource, StopsWhileItSkips) {
    SourceMap sources;
    Diagnostics diagnostics;
    LowerOptions options;
    options.may_be_orbit = true;
    const auto lowered = lower_text(
        "o.rifs", "orbit o { skip 1000000000  map { x = x/2  y = 0 } map { x = x/2 + 1/2  y = 0 } }\n",
        options, sources, diagnostics);
    ASSERT_TRUE(lowered.notes.orbit) << diagnostics.render(sources);
    const OrbitSource source(*lowered.notes.orbit, 1);
    int asked = 0;
    const Stopped stopped = [&] { return ++asked == 3; };
    std::vector<ChaosPoint> points(10);
    EXPECT_FALSE(source.stream(5, stopped)->fill(points));
    EXPECT_EQ(asked, 3);
    asked = 0;
    EXPECT_TRUE(source.survey(1000, stopped).box.empty());
    EXPECT_EQ(asked, 3);
}

/// A source whose stream 1 goes astray at once; stream 0 waits for that.
class AstraySource : public PointSource {
  public:
    std::unique_ptr<PointStream> stream(std::uint64_t number, const Stopped&) const override {
        return std::make_unique<Stream>(*this, number);
    }
    std::optional<FlatGame> flat(const Affine&, const LabelColour&, std::string&) const override {
        return std::nullopt;
    }

  private:
    class Stream : public PointStream {
      public:
        Stream(const AstraySource& source, std::uint64_t number) : source_(source), number_(number) {}
        Stream(const Stream&) = delete;
        Stream& operator=(const Stream&) = delete;
        ~Stream() override {
            if (number_ == 1) source_.astray_.set_value();
        }
        bool fill(std::span<ChaosPoint> points) override {
            std::ranges::fill(points, ChaosPoint());
            if (number_ == 0) source_.is_astray_.wait_for(std::chrono::seconds(10));
            return number_ != 1;
        }

      private:
        const AstraySource& source_;
        std::uint64_t number_;
    };

    mutable std::promise<void> astray_;
    std::shared_future<void> is_astray_ = astray_.get_future().share();
};

TEST(PointSource, StreamsBeforeOneThatGoesAstrayGoOn) {
    PointWork work;
    work.points = 3 * points_of_stream;
    work.threads = 2;
    std::uint64_t taken = 0; // by stream 0 alone
    EXPECT_FALSE(take_points(AstraySource(), work,
                             [&](int, std::span<const ChaosPoint> points) { taken += points.size(); }));
    EXPECT_EQ(taken, points_of_stream);
    taken = 0;
    const auto make = [&](std::span<const ChaosPoint> points, std::vector<char>&) { taken += points.size(); };
    EXPECT_FALSE(write_points(AstraySource(), work, make, [](const std::vector<char>&) { return true; }));
    EXPECT_EQ(taken, points_of_stream);
}

} // namespace
} // namespace graftal
