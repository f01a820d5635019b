// A Vulkan loader, libvulkan.so.1, that stands before the real one and lets one call fail:
//
//   VULKAN_FAULT=FUNCTION:N:RESULT   the N-th call of the function and all later ones give that VkResult
//
// tests/golden/gpu_faults_test.cpp has the program find it.

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <dlfcn.h>

namespace {

using Function = void (*)();
using Word = std::uintptr_t;
using GetFunction = Function (*)(void*, const char*);
using Call = int (*)(Word, Word, Word, Word, Word, Word);

std::string fault_function;
int fault_number = 0, fault_result = 0;
Call real_call = nullptr;
std::atomic<int> calls{0};

/// Every function that may fail takes at most six words.
int faulty(Word a, Word b, Word c, Word d, Word e, Word f) {
    return ++calls >= fault_number ? fault_result : real_call(a, b, c, d, e, f);
}

GetFunction real_loader() {
    static const GetFunction found = [] {
        if (const char* const fault = std::getenv("VULKAN_FAULT")) {
            const std::string text = fault;
            const std::size_t first = text.find(':'), second = text.find(':', first + 1);
            fault_function = text.substr(0, first);
            fault_number = std::atoi(text.c_str() + first + 1);
            fault_result = std::atoi(text.c_str() + second + 1);
        }
        void* const library = dlopen(GRAFTAL_VULKAN_LOADER, RTLD_NOW | RTLD_LOCAL);
        return library ? reinterpret_cast<GetFunction>(dlsym(library, "vkGetInstanceProcAddr")) : nullptr;
    }();
    return found;
}

} // namespace

extern "C" Function vkGetInstanceProcAddr(void* instance, const char* name) {
    const GetFunction real = real_loader();
    if (!real) return nullptr;
    const Function function = real(instance, name);
    if (!function || fault_function != name) return function;
    real_call = reinterpret_cast<Call>(function);
    return reinterpret_cast<Function>(&faulty);
}
