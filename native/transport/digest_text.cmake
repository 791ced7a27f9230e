# Writes a header with the digest of the text that computes transport, so that nothing older is taken for it.
set(all "")
foreach(file IN LISTS FILES)
  file(SHA256 "${file}" digest)
  string(APPEND all "${digest}")
endforeach()
string(SHA256 digest "${all}")
string(SUBSTRING "${digest}" 0 16 digest)
file(WRITE "${OUTPUT}.new" "// The text that computes transport, by its digest; written by native/transport/digest_text.cmake.
#pragma once

namespace mesograin::transport {
inline constexpr const char* text_digest = \"${digest}\";
}
")
file(RENAME "${OUTPUT}.new" "${OUTPUT}")
