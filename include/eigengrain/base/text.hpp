#pragma once

#include <cstdint>
#include <string>

namespace eigengrain {

/// 27440 -> "27,440", whatever the locale.
std::string grouped(std::int64_t number);

}  // namespace eigengrain
