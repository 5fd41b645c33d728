//! Known linkages, built as a user builds them.

use linkdyn_dynamics::RigidInertia;
use linkdyn_kinematics::dh::{Convention, Row};
use linkdyn_kinematics::{Joint, Pose};
use linkdyn_mechanisms::rfem::{Division, Material, Section, divide};
use linkdyn_mechanisms::{Along, FlexibleLink, Linkage, Mechanism, Mount, Start};
use nalgebra::{Matrix3, Unit, Vector3};

fn rod(length: f64) -> RigidInertia {
    RigidInertia::solid_cylinder(7850.0, 0.02, length, &Vector3::x())
}

/// Crank about z at the origin, rocker about x at `base`, a rod with two ball joints between their pins.
#[derive(Clone, Copy, Debug)]
pub struct Rssr {
    /// Length of the crank \[m\].
    pub crank: f64,
    /// Length of the rocker \[m\].
    pub rocker: f64,
    /// Base of the rocker \[m\].
    pub base: [f64; 3],
    /// Length of the rod \[m\].
    pub rod: f64,
}

impl Rssr {
    /// Whose crank turns all the way (benchmark 22-closed-form-loops).
    pub const FULL_TURN: Self = Self {
        crank: 0.1,
        rocker: 0.25,
        base: [0.3, 0.1, 0.2],
        rod: 0.45,
    };

    /// Whose crank locks near half a turn (benchmark 22-closed-form-loops).
    pub const LOCKING: Self = Self {
        base: [0.4, 0.1, 0.2],
        rod: 0.5,
        ..Self::FULL_TURN
    };

    /// The linkage with coordinates `theta` (crank), `rod.psi`, `rod.theta` and `phi` (rocker). The rod hangs on the crank by
    /// a universal joint: its idle spin is taken out.
    pub fn build(&self) -> Mechanism {
        let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
        let crank = linkage.link("crank", rod(self.crank));
        let coupler = linkage.link("rod", rod(self.rod));
        let rocker = linkage.link("rocker", rod(self.rocker));
        let ground = Linkage::GROUND;
        linkage.joint(
            "theta",
            Joint::revolute_z(),
            Mount::at_origin(ground),
            Mount::at_origin(crank),
        );
        let universal = Joint::Universal {
            first: Vector3::z_axis(),
            second: Vector3::y_axis(),
        };
        linkage.joint(
            "rod",
            universal,
            Mount::at(crank, [self.crank, 0.0, 0.0]),
            Mount::at_origin(coupler),
        );
        let about_x = Joint::Revolute {
            axis: Vector3::x_axis(),
        };
        linkage.joint("phi", about_x, Mount::at(ground, self.base), Mount::at_origin(rocker));
        linkage.cut(
            "S",
            Joint::Spherical,
            Mount::at(coupler, [self.rod, 0.0, 0.0]),
            Mount::at(rocker, [0.0, self.rocker, 0.0]),
        );
        linkage.build().expect("a valid linkage")
    }

    /// Pin of the crank at angle `theta` \[m\].
    pub fn pin(&self, theta: f64) -> Vector3<f64> {
        Vector3::new(theta.cos(), theta.sin(), 0.0) * self.crank
    }

    /// Pin of the rocker at angle `phi` \[m\].
    pub fn end(&self, phi: f64) -> Vector3<f64> {
        Vector3::from(self.base) + Vector3::new(0.0, phi.cos(), phi.sin()) * self.rocker
    }

    /// Both rocker angles for a crank angle, the one with the positive root first; `None` where the loop cannot be closed.
    pub fn rocker_angles(&self, theta: f64) -> Option<[f64; 2]> {
        let w = Vector3::from(self.base) - self.pin(theta);
        let (p, q) = (2.0 * self.rocker * w.z, 2.0 * self.rocker * w.y);
        let r = w.norm_squared() + self.rocker * self.rocker - self.rod * self.rod;
        let square = p * p + q * q - r * r;
        let angle = |root: f64| 2.0 * (-p + root).atan2(r - q);
        (square >= 0.0).then(|| [angle(square.sqrt()), angle(-square.sqrt())])
    }

    /// Both angles of the rod between two pins.
    pub fn rod_angles(&self, theta: f64, phi: f64) -> [f64; 2] {
        let u = self.end(phi) - self.pin(theta);
        let first = u.y.atan2(u.x);
        [first - theta, (-u.z).atan2(u.x.hypot(u.y))]
    }
}

/// A planar four-bar with bars along x of their links, in any plane of space.
#[derive(Clone, Copy, Debug)]
pub struct FourBar {
    /// Crank, coupler, rocker, frame \[m\].
    pub lengths: [f64; 4],
    /// Where its plane z = 0 lies in space.
    pub plane: Pose,
    /// The joint that closes it: any that lets the bars turn in their plane.
    pub closing: Joint,
}

impl FourBar {
    /// The linkage with coordinates `crank`, `coupler`, `rocker`, under gravity of no symmetry.
    pub fn linkage(&self) -> Linkage {
        let [a, b, c, d] = self.lengths;
        let mut linkage = Linkage::new([3.0, -7.0, 5.0]);
        let [crank, coupler, rocker] =
            [("crank", a), ("coupler", b), ("rocker", c)].map(|(name, length)| linkage.link(name, rod(length)));
        let z = Joint::revolute_z();
        let ground = Linkage::GROUND;
        let second_base = self.plane * Pose::translation(d, 0.0, 0.0);
        linkage.joint(
            "crank",
            z,
            Mount::with_pose(ground, self.plane),
            Mount::at_origin(crank),
        );
        linkage.joint("coupler", z, Mount::at(crank, [a, 0.0, 0.0]), Mount::at_origin(coupler));
        linkage.joint(
            "rocker",
            z,
            Mount::with_pose(ground, second_base),
            Mount::at_origin(rocker),
        );
        let ends = [Mount::at(coupler, [b, 0.0, 0.0]), Mount::at(rocker, [c, 0.0, 0.0])];
        linkage.cut("pin", self.closing, ends[0], ends[1]);
        linkage
    }
}

/// Bennett's loop of four revolute joints with link lengths `a`, `b`, `a`, `b` and twists \[rad\] `alpha`, `beta`, `alpha`,
/// `beta`; coordinates `th1`, `th2`, `th3`, the fourth joint cut.
pub fn bennett([a, b]: [f64; 2], [alpha, beta]: [f64; 2]) -> Mechanism {
    let row = |a, alpha| Row {
        theta: 0.0,
        d: 0.0,
        a,
        alpha,
    };
    let (_, long) = row(a, alpha).around(Convention::Classical);
    let (_, short) = row(b, beta).around(Convention::Classical);
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let links = ["1", "2", "3"].map(|name| linkage.link(name, rod(0.5)));
    let ground = Linkage::GROUND;
    let bases = [
        Mount::at_origin(ground),
        Mount::with_pose(links[0], long),
        Mount::with_pose(links[1], short),
    ];
    for ((name, base), link) in ["th1", "th2", "th3"].into_iter().zip(bases).zip(links) {
        linkage.joint(name, Joint::revolute_z(), base, Mount::at_origin(link));
    }
    let last = (
        Mount::with_pose(links[2], long),
        Mount::with_pose(ground, short.inverse()),
    );
    linkage.cut("th4", Joint::revolute_z(), last.0, last.1);
    linkage.build().expect("a valid linkage")
}

/// Two shafts that meet under the angle `beta` \[rad\], coupled by a Cardan joint; coordinates `input`, `output`.
pub fn cardan(beta: f64) -> Mechanism {
    let mut linkage = Linkage::new([0.0, 0.0, -9.81]);
    let wheel = RigidInertia::solid_cylinder(7850.0, 0.1, 0.02, &Vector3::z());
    let (input, output) = (linkage.link("input", wheel), linkage.link("output", wheel));
    let ground = Linkage::GROUND;
    let tilted = Joint::Revolute {
        axis: Unit::new_normalize(Vector3::new(beta.sin(), 0.0, beta.cos())),
    };
    linkage.joint(
        "input",
        Joint::revolute_z(),
        Mount::at_origin(ground),
        Mount::at_origin(input),
    );
    linkage.joint("output", tilted, Mount::at_origin(ground), Mount::at_origin(output));
    let cross = Joint::Universal {
        first: Vector3::x_axis(),
        second: Vector3::y_axis(),
    };
    linkage.cut("cross", cross, Mount::at_origin(input), Mount::at_origin(output));
    linkage.build().expect("a valid linkage")
}

/// Bricard's loop of six revolute joints \[IFToMM A04\]: five rods of 1 m along the edges of a cube, coordinates `t0` to `t4`, the sixth
/// joint cut. At zero coordinates it is closed.
pub fn bricard() -> Mechanism {
    let points = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, -1.0, 0.0],
        [1.0, -1.0, 1.0],
        [0.0, -1.0, 1.0],
        [0.0, 0.0, 1.0],
    ]
    .map(Vector3::from);
    let axes = [1, 2, 0, 1, 2, 0].map(|axis| Unit::new_unchecked(Vector3::ith(axis, 1.0)));
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let mut last = Mount::at_origin(Linkage::GROUND);
    for k in 0..5 {
        let arm = points[k + 1] - points[k];
        // A box of 1 x 0.1 x 0.1 m and 1 kg.
        let (slender, round) = (1.01 / 12.0, 0.02 / 12.0);
        let about_com = Matrix3::identity() * slender + arm * arm.transpose() * (round - slender);
        let com = arm * 0.5;
        let link = linkage.link(
            &format!("rod{k}"),
            RigidInertia {
                mass: 1.0,
                com,
                about_com,
            },
        );
        linkage.joint(
            &format!("t{k}"),
            Joint::Revolute { axis: axes[k] },
            last,
            Mount::at_origin(link),
        );
        last = Mount::at(link, arm.into());
    }
    linkage.cut(
        "t5",
        Joint::Revolute { axis: axes[5] },
        last,
        Mount::at(Linkage::GROUND, points[5].into()),
    );
    linkage.build().expect("a valid linkage")
}

/// A chain of point-like links in the plane z = 0, hung from the ground by turns `a0`, `a1`, ... about z; link k is a massless bar of the
/// given length \[m\] with a mass \[kg\] at its end, hanging along -y at zero angles.
pub fn hanging(links: &[(f64, f64)]) -> Linkage {
    let mut linkage = Linkage::new([0.0, -9.81, 0.0]);
    let mut last = Mount::at_origin(Linkage::GROUND);
    for (k, &(length, mass)) in links.iter().enumerate() {
        let inertia = RigidInertia {
            mass,
            com: Vector3::new(0.0, -length, 0.0),
            about_com: Matrix3::zeros(),
        };
        let link = linkage.link(&format!("bar{k}"), inertia);
        linkage.joint(&format!("a{k}"), Joint::revolute_z(), last, Mount::at_origin(link));
        last = Mount::at(link, [0.0, -length, 0.0]);
    }
    linkage
}

/// A start from guessed positions, of which some are held.
pub fn start(positions: &[(&str, f64)], held: &[&str]) -> Start {
    Start {
        positions: positions
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect(),
        held: held.iter().map(|name| (*name).to_owned()).collect(),
        speeds: Vec::new(),
    }
}

/// The coordinates of a mechanism closed from there.
///
/// # Panics
/// If it does not close.
pub fn closed(mechanism: &Mechanism, positions: &[(&str, f64)], held: &[&str]) -> Vec<f64> {
    mechanism.assemble(&start(positions, held)).expect("closes").0.q
}

/// A steel bar of 1 m and 10 x 10 mm along x in `n` elements, clamped at its beginning, under gravity \[m/s^2\] along -z.
pub struct Cantilever {
    /// The mechanism.
    pub mechanism: Mechanism,
    /// The bar's elements.
    pub link: FlexibleLink,
    /// Its section.
    pub section: Section,
    /// Its material.
    pub material: Material,
}

/// See [`Cantilever`]; the material's damping is given as a relaxation time \[s\].
///
/// # Panics
/// Not with a positive number of elements.
pub fn cantilever(n: usize, gravity: f64, relaxation_time: f64) -> Cantilever {
    let material = Material::isotropic(7850.0, 2.1e11, 0.3, relaxation_time).expect("a material");
    let section = Section::rectangle(0.01, 0.01).expect("a section");
    let beam = divide(1.0, &section, &material, Division::Standard(n)).expect("a beam");
    let mut linkage = Linkage::new([0.0, 0.0, -gravity]);
    let link = linkage.flexible_link("b", &beam, Along::X);
    linkage.joint(
        "clamp",
        Joint::Fixed,
        Mount::at_origin(Linkage::GROUND),
        Mount::at_origin(link.elements[0]),
    );
    let mechanism = linkage.build().expect("valid");
    Cantilever {
        mechanism,
        link,
        section,
        material,
    }
}
