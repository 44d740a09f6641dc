#include "eigengrain/contact/group.hpp"

namespace eigengrain::contact {

Contacts::Contacts() = default;
Contacts::Contacts(const Contacts&) = default;
Contacts::Contacts(Contacts&&) noexcept = default;
Contacts& Contacts::operator=(const Contacts&) = default;
Contacts& Contacts::operator=(Contacts&&) noexcept = default;
Contacts::~Contacts() = default;

std::int64_t Contacts::size() const {
  std::int64_t count = 0;
  for_each_group([&](const auto& group) { count += group.size(); });
  return count;
}

}  // namespace eigengrain::contact
