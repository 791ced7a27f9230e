// A list in the order of use.
#include "transport/walks_shelf.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace mesograin::transport {

std::shared_ptr<Walks> WalksShelf::find(const std::string& name) {
  const auto found = std::find_if(books_.begin(), books_.end(), [&](const Book& book) { return book.name == name; });
  if (found == books_.end()) return nullptr;
  books_.splice(books_.begin(), books_, found);
  return books_.front().walks;
}

void WalksShelf::put(const std::string& name, std::shared_ptr<Walks> walks) {
  books_.push_front({name, std::move(walks)});
}

void WalksShelf::trim() {
  std::size_t sum = 0;
  for (auto book = books_.begin(); book != books_.end();) {
    sum += book->walks->bytes();
    book = sum > limit_ && book != books_.begin() ? books_.erase(book) : std::next(book);
  }
}

}  // namespace mesograin::transport
