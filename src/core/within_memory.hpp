#pragma once

#include <burnish/error.hpp>
#include <new>

namespace burnish {

/// What body() returns; where memory runs out in it, Error{limit} with the text shortage().
template <class Shortage, class Body>
decltype(auto) within_memory(const Shortage& shortage, const Body& body) {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        throw Error(ErrorCode::limit, shortage());
    }
}

}  // namespace burnish
