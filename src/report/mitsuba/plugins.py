"""What Mitsuba lacks, written for it in Python: our metallic-roughness surface, two textures.

Only for `variant.use_plugins`.  Directions point away from the surface, c = cos θ from the normal
n_s, which a map may turn in the frame of the interpolated normal and the tangent:

    D  = α² / (π (c_h² (α² − 1) + 1)²),  α = max(roughness², 10⁻³)
    G₂ / (4 c_i c_o) = ½ / (c_i √(α² + (1 − α²) c_o²) + c_o √(α² + (1 − α²) c_i²))
    S(F₀, F₉₀) = D G₂ / (4 c_i c_o) (F₀ + (F₉₀ − F₀)(1 − ω·h)⁵)
    F(c) = F̂₀ + (F₉₀ − F̂₀)(1 − c)⁵,  F̂₀ the largest channel,  F̄ = 20/21 F̂₀ + 1/21 F₉₀
    f  = m S(ρ, 1) + (1 − m) (S(F₀, F₉₀) + ρ/π (1 − F(c_i)) (1 − F(c_o)) / (1 − F̄))

and 0 where n_s and the face's normal disagree on the side of a direction.
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

SMALLEST_ALPHA = 1e-3
# How often a direction is drawn about a visible normal; the rest is by the cosine.
SPECULAR_SHARE = 0.5
# The mesh's attribute.
TANGENTS = "vertex_tangent"


def texture_1(value, si, active):
    """A number, or a texture's."""
    return value.eval_1(si, active) if isinstance(value, mi.Texture) else mi.Float(value)


def texture_3(value, si, active):
    """A colour, or a texture's."""
    return value.eval(si, active) if isinstance(value, mi.Texture) else mi.Color3f(value)


def schlick(f0, f90, cos):
    """F₀ + (F₉₀ − F₀)(1 − c)⁵."""
    x = dr.maximum(1 - cos, 0)
    return f0 + (f90 - f0) * (dr.square(dr.square(x)) * x)


class Surface(mi.BSDF):
    """Both sides, with its own normals."""

    def __init__(self, props):
        super().__init__(props)
        self.color, self.roughness, self.metallic = (
            props[name] for name in ("color", "roughness", "metallic")
        )
        self.f0, self.f90 = mi.Color3f(props["f0"]), props["f90"]
        # The map's normals, its green already along n × t, and the tangents it goes by.
        self.normals = props["normals"] if "normals" in props else None
        flags = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.GlossyReflection
        self.m_components = [flags | mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide]
        self.m_flags = self.m_components[0]

    def traverse(self, callback):
        """Nothing of it is meant to be changed."""

    def frame(self, si, active):
        """About n_s, in the frame of the interpolated normal."""
        if self.normals is None:
            return mi.Frame3f(mi.Vector3f(0, 0, 1))
        tangent = si.sh_frame.to_local(si.shape.eval_attribute_3(TANGENTS, si, active))
        tangent = dr.normalize(mi.Vector3f(tangent.x, tangent.y, 0))
        bitangent = mi.Vector3f(-tangent.y, tangent.x, 0)
        n = 2 * self.normals.eval_3(si, active) - 1
        n = n.x * tangent + n.y * bitangent + mi.Vector3f(0, 0, n.z)
        return mi.Frame3f(dr.normalize(n))

    def seen(self, si, frame, w):
        """A direction about n_s, and if both normals have it on the same side."""
        local, n_g = frame.to_local(w), si.sh_frame.to_local(si.n)
        return local, local.z * dr.dot(n_g, w) > 0

    def microfacets(self, si, active):
        """α and the distribution of normals."""
        alpha = dr.square(texture_1(self.roughness, si, active))
        alpha = dr.maximum(alpha, SMALLEST_ALPHA)
        return alpha, mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)

    def eval_pdf(self, ctx, si, wo, active=True):
        """f |ω_o·n_s| and the density of `sample`, sr⁻¹."""
        frame = self.frame(si, active)
        (wi, known_i), (wo, known_o) = self.seen(si, frame, si.wi), self.seen(si, frame, wo)
        active = mi.Bool(active) & known_i & known_o & (wi.z * wo.z > 0)
        side = dr.sign(wi.z)
        wi, wo = wi * side, wo * side
        alpha, normals = self.microfacets(si, active)
        h, a2 = dr.normalize(wi + wo), dr.square(alpha)
        d = a2 / (dr.pi * dr.square(dr.square(h.z) * (a2 - 1) + 1))
        g = [x * dr.sqrt(a2 + (1 - a2) * dr.square(y)) for x, y in ((wi.z, wo.z), (wo.z, wi.z))]
        specular, cos = d * 0.5 / (g[0] + g[1]), dr.dot(wi, h)
        rho, metallic = texture_3(self.color, si, active), texture_1(self.metallic, si, active)
        top = dr.max(self.f0)
        mean = top * (20 / 21) + self.f90 / 21
        losses = (1 - schlick(top, self.f90, wi.z)) * (1 - schlick(top, self.f90, wo.z))
        f = metallic * specular * schlick(rho, mi.Color3f(1), cos) + (1 - metallic) * (
            specular * schlick(self.f0, mi.Color3f(self.f90), cos)
            + rho * (dr.inv_pi * losses / (1 - mean))
        )
        pdf = SPECULAR_SHARE * normals.pdf(wi, h) / (4 * dr.dot(wo, h))
        pdf += (1 - SPECULAR_SHARE) * wo.z * dr.inv_pi
        return dr.select(active, f * wo.z, 0), dr.select(active, pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        """f |ω_o·n_s|."""
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        """The density of `sample`, sr⁻¹."""
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        """A direction and f |ω_o·n_s| over its density."""
        frame = self.frame(si, active)
        wi = frame.to_local(si.wi)
        side = dr.sign(wi.z)
        h, _ = self.microfacets(si, active)[1].sample(wi * side, sample2)
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        wo = dr.select(sample1 < SPECULAR_SHARE, mi.reflect(wi * side, h), diffuse)
        result = mi.BSDFSample3f()
        result.wo = frame.to_world(wo * side)
        value, result.pdf = self.eval_pdf(ctx, si, result.wo, active)
        result.eta = 1.0
        result.sampled_component = mi.UInt32(0)
        result.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        return result, dr.select(result.pdf > 0, value / result.pdf, 0)

    def to_string(self):
        """Its name."""
        return "Surface[]"


class Product(mi.Texture):
    """The product of two textures."""

    def __init__(self, props):
        super().__init__(props)
        self.factors = [props[name] for name in ("first", "second")]

    def eval(self, si, active=True):
        """A colour."""
        return self.factors[0].eval(si, active) * self.factors[1].eval(si, active)

    def eval_1(self, si, active=True):
        """A number."""
        return self.factors[0].eval_1(si, active) * self.factors[1].eval_1(si, active)

    def is_spatially_varying(self):
        """It is."""
        return True

    def to_string(self):
        """Its name."""
        return "Product[]"


class Cutoff(mi.Texture):
    """1 where another texture is at least `cutoff`, 0 elsewhere."""

    def __init__(self, props):
        super().__init__(props)
        self.nested, self.cutoff = props["nested"], props["cutoff"]

    def eval_1(self, si, active=True):
        """A number."""
        return dr.select(self.nested.eval_1(si, active) >= self.cutoff, mi.Float(1), mi.Float(0))

    def is_spatially_varying(self):
        """It is."""
        return True

    def to_string(self):
        """Its name."""
        return "Cutoff[]"


mi.register_bsdf("gltf_surface", Surface)
mi.register_texture("gltf_product", Product)
mi.register_texture("gltf_cutoff", Cutoff)
