# Writes SOURCE, which holds the files of the folder PAGE, unless it is that already.
file(GLOB files ${PAGE}/*)
list(SORT files)
set(bytes "")
set(table "")
set(number 0)
foreach(file ${files})
  get_filename_component(name ${file} NAME)
  get_filename_component(ending ${file} LAST_EXT)
  if(ending STREQUAL ".html")
    set(type "text/html; charset=utf-8")
  elseif(ending STREQUAL ".js")
    set(type "text/javascript; charset=utf-8")
  elseif(ending STREQUAL ".css")
    set(type "text/css; charset=utf-8")
  elseif(ending STREQUAL ".svg")
    set(type "image/svg+xml")
  elseif(ending STREQUAL ".png")
    set(type "image/png")
  elseif(ending STREQUAL ".wasm")
    set(type "application/wasm")
  elseif(ending STREQUAL ".json")
    set(type "application/json")
  else()
    set(type "application/octet-stream")
  endif()
  file(SHA256 ${file} hash)
  string(APPEND bytes "// ${hash}
asm(\".section .rodata\\n\"
    \"graftal_page_${number}: .incbin \\\"${file}\\\"\\n\"
    \"graftal_page_${number}_end: .byte 0\\n\"
    \".previous\\n\");
extern \"C\" const char graftal_page_${number}[], graftal_page_${number}_end[];
")
  string(APPEND table "        {\"${name}\", \"${type}\", between(graftal_page_${number}, graftal_page_${number}_end)},\n")
  math(EXPR number "${number} + 1")
endforeach()
set(text "// Made by cmake/embed_page.cmake.
#include \"runtime/studio/server/page_files.h\"

${bytes}
namespace graftal {

static std::string_view between(const char* begin, const char* end) {
    return {begin, static_cast<std::size_t>(end - begin)};
}

std::span<const PageFile> page_files() {
    static const PageFile files[] = {
${table}    };
    return files;
}

} // namespace graftal
")
set(before "")
if(EXISTS ${SOURCE})
  file(READ ${SOURCE} before)
endif()
if(NOT before STREQUAL text)
  file(WRITE ${SOURCE} "${text}")
endif()
