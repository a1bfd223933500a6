# Run by aspic_embed_files at build time: writes HEADER and SOURCE from the files named in LIST_FILE.
file(READ "${LIST_FILE}" files)
string(STRIP "${files}" files)

set(delimiter "aspic_file")
set(entries "")
foreach(file IN LISTS files)
  file(READ "${file}" text)
  string(FIND "${text}" ")${delimiter}\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${file} contains the characters )${delimiter}\" and cannot be embedded")
  endif()
  file(RELATIVE_PATH name "${BASE}" "${file}")
  string(APPEND entries "    {\"${name}\", R\"${delimiter}(${text})${delimiter}\"},\n")
endforeach()

file(WRITE "${HEADER}" "#pragma once
#include <span>

#include \"base/embedded_file.h\"

namespace aspic::${NAMESPACE} {
std::span<const EmbeddedFile> embedded_files();
}  // namespace aspic::${NAMESPACE}
")
file(WRITE "${SOURCE}" "#include \"embedded/${NAMESPACE}.h\"

namespace aspic::${NAMESPACE} {
namespace {
constexpr EmbeddedFile files[] = {
${entries}};
}  // namespace
std::span<const EmbeddedFile> embedded_files() { return files; }
}  // namespace aspic::${NAMESPACE}
")
