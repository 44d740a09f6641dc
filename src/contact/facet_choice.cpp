#include "eigengrain/contact/facet_choice.hpp"

#include <algorithm>
#include <cmath>

namespace eigengrain::contact {
namespace {

using Kind = FacetFeature::Kind;

/// What a facet offers to a ball.
struct Offer {
  const model::Facet* facet = nullptr;
  model::Image image{};
  FacetFeature feature;
  double distance = 0;  ///< of the nearest point, never negative
  double height = 0;    ///< positive on the side of the normal there
  Vec3 direction;       ///< n of the contact, in the frame of the surface
  int side = 0;
  bool counts = true;
};

/// The identities of the corners of an edge or corner; the second is -1 at a corner.
std::array<std::int32_t, 2> ends_of(const Offer& offer) {
  const auto k = static_cast<std::size_t>(offer.feature.k);
  const auto& vertex = offer.facet->vertex;
  return {vertex[k], offer.feature.kind == Kind::edge ? vertex[(k + 1) % 3] : -1};
}

/// Whether the facet has the other one's edge or corner.
bool has_feature_of(const Offer& facet, const Offer& other) {
  if (facet.image != other.image) return false;
  const auto has = [&](std::int32_t vertex) {
    return vertex < 0 || std::find(facet.facet->vertex.begin(), facet.facet->vertex.end(), vertex) !=
                             facet.facet->vertex.end();
  };
  const auto ends = ends_of(other);
  return has(ends[0]) && has(ends[1]);
}

bool same_feature(const Offer& one, const Offer& two) {
  if (one.image != two.image) return false;
  if (one.feature.kind != two.feature.kind) return false;
  auto a = ends_of(one);
  auto b = ends_of(two);
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  return a == b;
}

/// Whether a facet takes an edge or corner away from another: because it has it too, and is nearer.
bool takes(const Offer& facet, const Offer& other) {
  if (!has_feature_of(facet, other)) return false;
  if (facet.feature.kind == Kind::face) return true;
  if (same_feature(facet, other) || facet.distance > other.distance) return false;
  // An edge and its own end, told apart by rounding alone, must not take each other away.
  const auto ends = ends_of(other);
  const bool own_end = facet.feature.kind == Kind::corner &&
                       std::find(ends.begin(), ends.end(), ends_of(facet)[0]) != ends.end();
  return !(own_end && other.feature.kind == Kind::edge);
}

/// Offers are in the order of their facets, which decides between equals.
void sort_by_distance(std::vector<Offer*>& order) {
  std::sort(order.begin(), order.end(), [](const Offer* l, const Offer* r) {
    return l->distance != r->distance ? l->distance < r->distance : l < r;
  });
}

/// Normal of the surface at the nearest point: its sign tells outside from inside.
Vec3 normal_at(const model::Facets& facets, const Offer& offer) {
  const auto k = static_cast<std::size_t>(offer.feature.k);
  switch (offer.feature.kind) {
    case Kind::edge:
      return offer.facet->edge_normal[k];
    case Kind::corner:
      return facets.vertex_normal[static_cast<std::size_t>(offer.facet->vertex[k])];
    case Kind::face:
      break;
  }
  return offer.facet->normal;
}

Offer offer_of(const Placement& placement, const Pair& pair) {
  Offer offer;
  offer.facet = &placement.facets->facet[static_cast<std::size_t>(pair.b)];
  offer.image = pair.image;
  const Vec3 x = BallFacet::local_centre(placement, placement.surfaces, pair);
  const NearestPoint nearest = nearest_point(x, *offer.facet);
  offer.feature = nearest.feature;
  if (offer.feature.kind == Kind::face) {
    offer.height = (x - offer.facet->corner[0]).dot(offer.facet->normal);
    offer.distance = std::abs(offer.height);
  } else {
    const Vec3 branch = nearest.point - x;
    offer.distance = branch.norm();
    offer.direction = branch / offer.distance;
    offer.height = -branch.dot(normal_at(*placement.facets, offer));
  }
  return offer;
}

/// The side that a facet remembers; 0 for a pair that is new.
int remembered(const Pair& pair) {
  return pair.side == 0 ? 0 : (pair.side > 0 ? 1 : -1);
}

int side_of_height(double height) {
  return height >= 0 ? 1 : -1;
}

/// Rules 2 and 3, from the nearest offer on: who takes an edge or corner is nearer, so its side is known.
/// The nearest of all is always left to count.
void find_sides_and_takers(std::span<const Pair> pairs, std::span<Offer> offers) {
  thread_local std::vector<Offer*> order;
  order.clear();
  for (std::size_t c = 0; c < offers.size(); ++c) {
    order.push_back(&offers[c]);
    if (offers[c].feature.kind != Kind::face) continue;
    const int before = remembered(pairs[c]);
    offers[c].side = before != 0 ? before : side_of_height(offers[c].height);
    offers[c].direction = -offers[c].side * offers[c].facet->normal;
  }
  sort_by_distance(order);
  for (Offer* offer : order) {
    if (offer->feature.kind == Kind::face) continue;
    const auto taker = std::find_if(order.begin(), order.end(), [&](const Offer* other) {
      return other != offer && other->side != 0 && takes(*other, *offer);
    });
    offer->side = taker != order.end() ? (*taker)->side : side_of_height(offer->height);
    offer->counts = taker == order.end() || offer == order.front();
  }
}

/// Rule 4.
void merge(std::span<Offer> offers) {
  thread_local std::vector<Offer*> order;
  order.clear();
  for (Offer& offer : offers)
    if (offer.counts) order.push_back(&offer);
  sort_by_distance(order);
  for (std::size_t c = 1; c < order.size(); ++c)
    order[c]->counts =
        std::none_of(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(c), [&](const Offer* nearer) {
          return nearer->counts && nearer->direction.dot(order[c]->direction) > one_contact;
        });
}

}  // namespace

void choose_facets(const Placement& placement, std::span<Pair> pairs, std::span<Vec3> directions) {
  thread_local std::vector<Offer> offers;
  offers.clear();
  for (const Pair& pair : pairs) offers.push_back(offer_of(placement, pair));
  find_sides_and_takers(pairs, offers);
  const bool two_sided =
      placement.facets->two_sided[static_cast<std::size_t>(offers.front().facet->surface)] != 0;
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    // A face knows from which side the ball came, and pushes it back there.
    const bool has_direction = offers[c].distance > 0 || remembered(pairs[c]) != 0;
    if (!has_direction || (offers[c].distance == 0 && offers[c].feature.kind != Kind::face))
      throw CentreOnFacet{pairs[c].a, pairs[c].b};
    offers[c].counts = offers[c].counts && (two_sided || offers[c].side > 0);
  }
  if (pairs.size() > 1) merge(offers);
  for (std::size_t c = 0; c < pairs.size(); ++c) {
    pairs[c].side = static_cast<std::int8_t>(offers[c].counts ? offers[c].side : 2 * offers[c].side);
    directions[c] = offers[c].direction;
  }
}

}  // namespace eigengrain::contact
