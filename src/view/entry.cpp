#include <fmt/format.h>

#include <burnish/files.hpp>
#include <cstdio>

#include "view/session.hpp"
#include "view/view.hpp"
#include "view/viewer.hpp"

namespace burnish::view {
namespace {

Session first_session(const ViewRequest& request) {
    Session session(request.load);
    if (request.load_state.empty()) {
        session.open(request.input);
        session.state.width = session.loaded().width;
        session.state.height = session.loaded().height;
    } else {
        session.open(load_view_state(request.load_state));
    }
    if (request.size) {
        session.state.width = request.size->x;
        session.state.height = request.size->y;
    }
    if (request.quiet || !session.wish(false)) return session;
    for (const std::string& line : session.edit_messages())
        fmt::print(stderr, "burnish: {}\n", line);
    return session;
}

}  // namespace

void view(const ViewRequest& request) {
    Viewer(request, first_session(request)).run();
}

}  // namespace burnish::view

/// What the command looks up when it is asked for a window.
extern "C" void burnish_view(const burnish::view::ViewRequest& request) {
    burnish::view::view(request);
}
