#include "runtime/system/signal_registry.h"

#include <array>
#include <csignal>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace graftal {
namespace {

using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

template<typename T, std::size_t places>
std::vector<const T*> items_of(const SignalRegistry<T, places>& registry) {
    std::vector<const T*> items;
    registry.for_each([&](const T* item) { items.push_back(item); });
    return items;
}

TEST(SignalRegistry, HoldsWhatIsNotedUntilItIsForgotten) {
    SignalRegistry<int, 3> registry;
    const int a = 0, b = 0;
    EXPECT_THAT(items_of(registry), IsEmpty());
    registry.note(&a);
    registry.note(&b);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&a, &b));
    registry.forget(&a);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&b));
    registry.forget(&a);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&b)) << "it was forgotten before";
}

TEST(SignalRegistry, WhatFindsNoPlaceTakesNobodysAndAFreePlaceServesAgain) {
    SignalRegistry<int, 2> registry;
    const int a = 0, b = 0, c = 0;
    for (const int* item : {&a, &b, &c})
        registry.note(item);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&a, &b));
    registry.forget(&c);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&a, &b));
    registry.forget(&a);
    registry.note(&c);
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&b, &c));
}

TEST(SignalRegistry, ThreadsShareThePlaces) {
    constexpr std::size_t threads = 4, rounds = 10'000;
    SignalRegistry<int, threads> registry;
    const std::array<int, threads> items = {};
    std::vector<std::thread> running;
    for (const int& item : items)
        running.emplace_back([&registry, &item] {
            for (std::size_t round = 0; round < rounds; ++round) {
                registry.note(&item);
                registry.forget(&item);
            }
            registry.note(&item);
        });
    for (std::thread& thread : running)
        thread.join();
    EXPECT_THAT(items_of(registry), UnorderedElementsAre(&items[0], &items[1], &items[2], &items[3]));
}

SignalRegistry<int, 8> noted;
volatile std::sig_atomic_t seen = 0;

TEST(SignalRegistry, AHandlerSeesIt) {
    const int a = 1, b = 2;
    noted.note(&a);
    noted.note(&b);
    const auto before =
        std::signal(SIGUSR1, [](int) { noted.for_each([](const int* item) { seen = seen + *item; }); });
    std::raise(SIGUSR1);
    std::signal(SIGUSR1, before);
    EXPECT_EQ(seen, 3);
}

} // namespace
} // namespace graftal
