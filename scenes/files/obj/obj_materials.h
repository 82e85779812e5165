#pragma once
#include "scenes/baked_uv.h"
#include "scenes/files/obj/mtl_document.h"
#include "scenes/files/obj/obj_pictures.h"
#include "scenes/scene.h"

namespace trueshade::obj {

/// A material of an MTL file as a scene's, whose coordinates are left to bake_uv(); its pictures become textures of the
/// scene. docs/obj.md has the rules.
Material material_of(const MtlDocument& document, const MtlMaterial& from, ObjPictures& pictures);

/// The pictures that material_of() asks for.
std::vector<const MapSource*> maps_of(const MtlMaterial& material);

/// What its maps read.
UvSources uv_sources_of(const MtlMaterial& material);

}  // namespace trueshade::obj
