#include "runtime/points/point_source.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "runtime/system/worker_threads.h"

namespace graftal {

namespace {

constexpr std::size_t batch_size = 512;
/// A cloud is written by pieces of this size.
constexpr std::size_t piece_size = 1u << 15;

class ChaosStream : public PointStream {
  public:
    ChaosStream(const ChaosGame& game, std::uint64_t seed, std::uint64_t number)
        : player_(game, seed, number) {}
    bool fill(std::span<ChaosPoint> points) override {
        player_.fill(points);
        return true;
    }

  private:
    ChaosPlayer player_;
};

/// Tells how far the work is, now and then, from whatever thread.
class PointProgress {
  public:
    explicit PointProgress(const PointWork& work) : work_(work) {}

    void add(std::uint64_t points) {
        const std::uint64_t done = done_.fetch_add(points) + points;
        if (!work_.on_progress) return;
        const std::unique_lock lock(telling_, std::try_to_lock);
        if (!lock) return;
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return;
        next_ = now + std::chrono::milliseconds(100);
        work_.on_progress(static_cast<double>(done) / static_cast<double>(work_.points));
    }
    bool stopped(std::uint64_t stream) {
        if (work_.cancelled && end_ > 0 && work_.cancelled()) end_ = 0;
        return stream >= end_;
    }
    bool complete() const { return end_ == UINT64_MAX; }
    /// Stops the stream and those after it.
    void stop_from(std::uint64_t stream) {
        for (std::uint64_t end = end_; stream < end && !end_.compare_exchange_weak(end, stream);) {
        }
    }

  private:
    const PointWork& work_;
    std::atomic<std::uint64_t> done_ = 0;
    std::atomic<std::uint64_t> end_ = UINT64_MAX; ///< of the streams that go on
    std::mutex telling_;
    std::chrono::steady_clock::time_point next_;
};

/// Lets threads that have a number each go on one after the other, in the order of the numbers.
class Turns {
  public:
    /// Ends with this, however that ends.
    class Turn {
      public:
        Turn(Turns& turns, std::uint64_t number) : turns_(turns), number_(number) {}
        ~Turn() {
            wait();
            const std::lock_guard lock(turns_.mutex_);
            ++turns_.next_;
            turns_.changed_.notify_all();
        }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

        void wait() const {
            std::unique_lock lock(turns_.mutex_);
            turns_.changed_.wait(lock, [this] { return turns_.next_ == number_; });
        }

      private:
        Turns& turns_;
        std::uint64_t number_;
    };

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::uint64_t next_ = 0;
};

std::uint64_t stream_count(const PointSource& source, const PointWork& work) {
    return source.single() ? 1 : (work.points + points_of_stream - 1) / points_of_stream;
}

/// The points of stream `number`, in batches.
template<typename Take>
void play(const PointSource& source, const PointWork& work, std::uint64_t number, PointProgress& progress,
          const Take& take) {
    const std::uint64_t first = number * points_of_stream;
    std::uint64_t left = source.single() ? work.points : std::min(points_of_stream, work.points - first);
    const auto stopped = [&progress, number] { return progress.stopped(number); };
    const std::unique_ptr<PointStream> stream = source.stream(number, stopped);
    std::vector<ChaosPoint> batch(batch_size);
    for (std::uint64_t told = left; left > 0 && !stopped();) {
        const std::span<ChaosPoint> points(batch.data(), std::min<std::uint64_t>(batch_size, left));
        if (!stream->fill(points)) return progress.stop_from(number);
        take(points);
        left -= points.size();
        if (told - left < points_of_stream && left > 0) continue;
        progress.add(told - left);
        told = left;
    }
}

} // namespace

std::unique_ptr<PointStream> ChaosSource::stream(std::uint64_t number, const Stopped&) const {
    return std::make_unique<ChaosStream>(game_, seed_, number);
}

int worker_count(int threads) {
    return WorkerThreads(threads).count();
}

bool take_points(const PointSource& source, const PointWork& work,
                 const std::function<void(int worker, std::span<const ChaosPoint>)>& take) {
    PointProgress progress(work);
    WorkerThreads(work.threads).for_each(stream_count(source, work), [&](int worker, std::uint64_t number) {
        if (progress.stopped(number)) return;
        play(source, work, number, progress,
             [&](std::span<const ChaosPoint> points) { take(worker, points); });
    });
    return progress.complete();
}

bool write_points(const PointSource& source, const PointWork& work,
                  const std::function<void(std::span<const ChaosPoint>, std::vector<char>&)>& make,
                  const std::function<bool(const std::vector<char>&)>& write) {
    PointProgress progress(work);
    const auto put = [&](std::uint64_t stream, const std::vector<char>& bytes) {
        if (!progress.stopped(stream) && !bytes.empty() && !write(bytes)) progress.stop_from(0);
    };
    if (source.single()) {
        std::vector<char> bytes;
        play(source, work, 0, progress, [&](std::span<const ChaosPoint> points) {
            make(points, bytes);
            if (bytes.size() < piece_size) return;
            put(0, bytes);
            bytes.clear();
        });
        put(0, bytes);
        return progress.complete();
    }
    Turns turns;
    WorkerThreads(work.threads).for_each(stream_count(source, work), [&](int, std::uint64_t number) {
        std::vector<char> bytes;
        const Turns::Turn turn(turns, number);
        play(source, work, number, progress,
             [&](std::span<const ChaosPoint> points) { make(points, bytes); });
        turn.wait();
        put(number, bytes);
    });
    return progress.complete();
}

} // namespace graftal
