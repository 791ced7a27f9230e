// Every sentence passes through here.
#include "base/error.h"

#include "base/readable.h"

namespace mesograin {

Error::Error(std::string_view sentence) : std::runtime_error(base::readable(sentence)) {}

}  // namespace mesograin
