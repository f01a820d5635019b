#include "compiler/lower/translator.h"

#include <utility>

#include "compiler/support/text_encoding.h"

namespace graftal {

Translator no_translator() {
    return {.model_path = [](std::string_view path) -> ModelPath {
                return {std::string(path), {}};
            },
            .model_text = [](std::string_view,
                             std::string bytes) { return decoded_text(std::move(bytes), OtherBytes::kept); },
            .own_text = [](FileId file, std::string_view, SourceMap&, Diagnostics&, const TranslateOptions&,
                           WorkMeter*) { return std::optional(file); }};
}

} // namespace graftal
