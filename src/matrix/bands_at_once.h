// Loops over bands whose number is known when they are compiled.
#pragma once

#include <algorithm>

namespace radiosity {

/// Calls some.template operator()<n>(b) for bands b to b + n - 1, all in turn, as many at once as
/// fit into registers; further ones take another walk, from the cache.
template <class Some>
void forBandsAtOnce(int bands, const Some& some) {
  constexpr int kAtOnce = 4;
  for (int b = 0; b < bands; b += kAtOnce) {
    switch (std::min(bands - b, kAtOnce)) {
      case 1:
        some.template operator()<1>(b);
        break;
      case 2:
        some.template operator()<2>(b);
        break;
      case 3:
        some.template operator()<3>(b);
        break;
      default:
        some.template operator()<kAtOnce>(b);
        break;
    }
  }
}

}  // namespace radiosity
