// Stored transport as bytes: a few lines of text that say what it is, the numbers, and their sum.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "transport/stored_transport.h"

namespace mesograin::transport {

/// `about` says in lines of text where it comes from.
std::string to_bytes(const StoredTransport& stored, std::string_view about);

/// Nothing if the bytes are not all there, were changed, or are about something else.
std::optional<StoredTransport> from_bytes(std::string_view bytes, std::string_view about);

}  // namespace mesograin::transport
