#pragma once

#include <array>

#include "base/tr.h"
#include "haptics/contact_force.h"
#include "haptics/contact_sphere.h"
#include "haptics/law_input.h"
#include "haptics/tool.h"

namespace trephine {

// Solid tissue holds the tool's proxy, and a spring of the tissue's stiffness k pulls the arm to
// it: f = k (proxy - arm), torque k r^2 (turn between them), r the length by which the proxy weighs
// turns against shifts (proxy.h).
//
// Soft tissue pushes the tool out along its smoothed normal: f = k depth n, summed over layers, as
// the tool's contact sphere feels it (contact_sphere.h). Once the sphere's centre is in tissue, its
// depth is counted from there along the normal with which it went in, however deep it sinks; where
// K falls the push falls with it, where K rises the depth shrinks with 1 / K, so that no energy is
// made. For a sharp tool, which cuts the tissue open, the push fades as the sphere sinks in. On the
// way out nothing of it comes back where no voxel went; where some did, the sides of the cut push
// by up to a tenth of it.
struct ElasticLaw {
  static constexpr LawWords kWords{
      "elastic", trLater("Elastic"),
      trLater("Tissue pushes back with its stiffness, and solid tissue stops a tool.")};
  static constexpr std::array kNumbers{&TickNumbers::stiffness_N_per_m};

  static constexpr bool kStopsAtSolid = true;

  // The stiffness that pushes on a contact sphere: of soft tissue in which the law acts. What is
  // solid stops the proxy instead.
  struct Tissues {
    void use(const TissueTable& tissues, std::uint32_t acts_in);

    StiffnessByLabel stiffness;
    bool any = false;
  };
  // The push on the contact sphere, the sphere's centre from the tip and its radius, and whether a
  // sharp tool cuts open the tissue before it.
  struct Answer {
    ElasticPush push;
    Vec3 sphere_m{0.0};
    double radius_m = 0.0;
    bool parts = false;
  };
  struct Query {
    Query(const Tool& tool, const GridGeometry& geometry);
    Answer ask(const Tissues& tissues, const TissueField& tissue, const Pose& tool_mm,
               const LawInput& in) const;

    ContactSphere sphere;
    double radius_m;
    bool blunt;
  };

  explicit ElasticLaw(std::size_t /*points*/ = 1) {}
  static Impedance impedance(const TissueClass& tissue) { return {0.0, tissue.stiffness_N_per_m}; }
  void add(const LawInput& in, const Answer& answer, ContactForce& out);
  void forget() { *this = ElasticLaw(); }

  template <class Self, class Archive>
  static void visitState(Self& self, Archive& archive) {
    archive(self.normal, self.depth_m, self.centre_m, self.stiffness, self.parted, self.most_N);
  }

  Vec3 normal{0.0};  // the last clear one, out of the tissue
  // Of a sphere whose centre is in tissue: its depth, where its centre was in the tick before, and
  // that tissue's stiffness.
  double depth_m = 0.0;
  Vec3 centre_m{0.0};
  double stiffness = 0.0;  // N/m; 0: the centre is in none
  // Of a tool that cuts the tissue open.
  bool parted = false;  // its sphere's centre has been in tissue that pushed less than K r
  double most_N = 0.0;  // then: the smallest push since, which bounds the next

 private:
  void addSolid(const LawInput& in, ContactForce& out) const;
  void addSoft(const LawInput& in, const Answer& answer, ContactForce& out);
};

}  // namespace trephine
