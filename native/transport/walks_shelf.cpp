// A list in the order of use.
#include "transport/walks_shelf.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace mesograin::transport {

std::shared_ptr<Walks> WalksShelf::find(const std::string& body, const std::string& quality) {
  const auto found = std::find_if(books_.begin(), books_.end(),
                                  [&](const Book& book) { return book.body == body && book.quality == quality; });
  if (found == books_.end()) return nullptr;
  books_.splice(books_.begin(), books_, found);
  return books_.front().walks;
}

void WalksShelf::put(const std::string& body, const std::string& quality, std::shared_ptr<Walks> walks) {
  books_.push_front({body, quality, std::move(walks)});
}

void WalksShelf::trim(const std::function<bool(const std::string& body)>& in_use) {
  std::size_t sum = 0;
  std::size_t sum_of_gone = 0;
  for (auto book = books_.begin(); book != books_.end();) {
    const std::size_t bytes = book->walks->bytes();
    const std::size_t bytes_of_gone = in_use(book->body) ? 0 : bytes;
    const bool too_many_gone = bytes_of_gone > 0 && sum_of_gone + bytes_of_gone > limit_of_gone_;
    if (too_many_gone || (sum + bytes > limit_ && book != books_.begin())) {
      book = books_.erase(book);
      continue;
    }
    sum += bytes;
    sum_of_gone += bytes_of_gone;
    ++book;
  }
}

std::size_t WalksShelf::bytes() const {
  std::size_t sum = 0;
  for (const Book& book : books_) sum += book.walks->bytes();
  return sum;
}

}  // namespace mesograin::transport
