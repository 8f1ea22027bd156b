#pragma once

#include <variant>

#include "kernels/kernel_table.hpp"

namespace burnish {

/// A register plane that nothing feeds.
struct ClearCtx {
    int plane;
};

/// A register plane that is another one, too.
struct CopyCtx {
    int from, to;
};

/// An attribute plane that is the same everywhere.
struct FillCtx {
    int attribute;
    float value;
};

/// The next `count` operations blend with a further level by the low 8 bits of register plane
/// `weight`: a packet where all of them are 0 does without.
struct BlendedCtx {
    int weight;
    int count;
};

/// The next `count` operations bring what one probe sees, at the coordinates that `point` leaves.
/// They run once for every probe that a fragment of the packet has, and the means that `sum`
/// describes take the place of the codes; where there is one probe the codes stay as they are.
struct ProbedCtx {
    ProbePointCtx point;
    ProbeSumCtx sum;
    int count;
};

/// Brings a packet's attributes to its registers, before the program runs or between its stages.
/// PrefetchQuartetCtx is in Shading's packet_inputs alone.
using InputOp =
    std::variant<ClearCtx, CopyCtx, FillCtx, LightingCtx, EncodeCtx, AddressCtx, FetchCtx,
                 DecodeCtx, AffineCtx, DotCtx, HemisphereCtx, OffsetCtx, ReflectCtx, QuotientCtx,
                 AngleCtx, CullCtx, MagnitudeCtx, CubeFaceCtx, PlaneFootprintCtx, QuadFootprintCtx,
                 LevelOfDetailCtx, LevelAddressCtx, FetchHiloCtx, FetchWordsCtx, FetchQuartetCtx,
                 LookUpTableCtx, AverageTableCtx, BlendLevelsCtx, HiloCtx, BlendedCtx,
                 PrefetchQuartetCtx, ProbeExtentCtx, ProbedCtx>;

}  // namespace burnish
