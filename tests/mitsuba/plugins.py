"""What Mitsuba lacks, written for it in Python: our metallic-roughness surface, two textures.

Only for `variant.use_plugins`.  Directions point away from the surface, c = cos θ from the normal:

    D  = α² / (π (c_h² (α² − 1) + 1)²),  α = max(roughness², 10⁻³)
    G₂ / (4 c_i c_o) = ½ / (c_i √(α² + (1 − α²) c_o²) + c_o √(α² + (1 − α²) c_i²))
    S(F₀, F₉₀) = D G₂ / (4 c_i c_o) (F₀ + (F₉₀ − F₀)(1 − ω·h)⁵)
    F(c) = F̂₀ + (F₉₀ − F̂₀)(1 − c)⁵,  F̂₀ the largest channel,  F̄ = 20/21 F̂₀ + 1/21 F₉₀
    f  = m S(ρ, 1) + (1 − m) (S(F₀, F₉₀) + ρ/π (1 − F(c_i)) (1 − F(c_o)) / (1 − F̄))
"""

from __future__ import annotations

import drjit as dr
import mitsuba as mi

SMALLEST_ALPHA = 1e-3
# How often a direction is drawn about a visible normal; the rest is by the cosine.
SPECULAR_SHARE = 0.5


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
    """Seen from the front; `twosided` does the rest."""

    def __init__(self, props):
        super().__init__(props)
        self.color, self.roughness, self.metallic = (
            props[name] for name in ("color", "roughness", "metallic")
        )
        self.f0, self.f90 = props["f0"], props["f90"]
        flags = mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.GlossyReflection
        self.m_components = [flags | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0]

    def traverse(self, callback):
        """Nothing of it is meant to be changed."""

    def alpha(self, si, active):
        """α."""
        return dr.maximum(dr.square(texture_1(self.roughness, si, active)), SMALLEST_ALPHA)

    def eval_pdf(self, ctx, si, wo, active=True):
        """f · cos θ_o and the density of `sample`, sr⁻¹."""
        wi, alpha = si.wi, self.alpha(si, active)
        active = mi.Bool(active) & (wi.z > 0) & (wo.z > 0)
        h, a2 = dr.normalize(wi + wo), dr.square(alpha)
        d = a2 / (dr.pi * dr.square(dr.square(h.z) * (a2 - 1) + 1))
        g = [x * dr.sqrt(a2 + (1 - a2) * dr.square(y)) for x, y in ((wi.z, wo.z), (wo.z, wi.z))]
        rho, metallic = texture_3(self.color, si, active), texture_1(self.metallic, si, active)
        cos, f0 = dr.dot(wi, h), mi.Color3f(self.f0)
        specular = d * 0.5 / (g[0] + g[1])
        top = dr.max(f0)
        mean = top * (20 / 21) + self.f90 / 21
        losses = (1 - schlick(top, self.f90, wi.z)) * (1 - schlick(top, self.f90, wo.z))
        f = metallic * specular * schlick(rho, mi.Color3f(1), cos) + (1 - metallic) * (
            specular * schlick(f0, mi.Color3f(self.f90), cos)
            + rho * (dr.inv_pi * losses / (1 - mean))
        )
        normals = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, alpha, True)
        pdf = SPECULAR_SHARE * normals.pdf(wi, h) / (4 * dr.dot(wo, h))
        pdf += (1 - SPECULAR_SHARE) * wo.z * dr.inv_pi
        return dr.select(active, f * wo.z, 0), dr.select(active, pdf, 0)

    def eval(self, ctx, si, wo, active=True):
        """f · cos θ_o."""
        return self.eval_pdf(ctx, si, wo, active)[0]

    def pdf(self, ctx, si, wo, active=True):
        """The density of `sample`, sr⁻¹."""
        return self.eval_pdf(ctx, si, wo, active)[1]

    def sample(self, ctx, si, sample1, sample2, active=True):
        """A direction and f · cos θ_o over its density."""
        normals = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha(si, active), True)
        h, _ = normals.sample(si.wi, sample2)
        diffuse = mi.warp.square_to_cosine_hemisphere(sample2)
        result = mi.BSDFSample3f()
        result.wo = dr.select(sample1 < SPECULAR_SHARE, mi.reflect(si.wi, h), diffuse)
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
