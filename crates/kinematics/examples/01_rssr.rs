//! A spatial four-bar RSSR over a full turn of its input, on both branches, against the closed form.
//!
//! Input pin a (cos th, sin th, 0), revolute about z at the origin; output pin o2 + b (0, cos ph, sin ph), revolute about x at
//! o2; a rod of length L with ball joints between the pins. With w = o2 - input pin, the rod's length asks for
//! P sin ph + Q cos ph + R = 0, P = 2 b w_z, Q = 2 b w_y, R = w^2 + b^2 - L^2.

use linkdyn_kinematics::assembly::{self, AssemblyError, Settings};
use linkdyn_kinematics::{Attachment, Closure, Joint, LinkId, Pose, Tree};
use nalgebra::Vector3;
use std::f64::consts::PI;

const INPUT: f64 = 0.1;
const OUTPUT: f64 = 0.25;
const ROD: f64 = 0.45;
const SECOND_BASE: [f64; 3] = [0.3, 0.1, 0.2];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut tree = Tree::new();
    let [x, y, z] = SECOND_BASE;
    let input = tree.attach(LinkId::GROUND, Pose::identity(), Joint::revolute_z())?;
    let rod = tree.attach(input, Pose::translation(INPUT, 0.0, 0.0), Joint::Spherical)?;
    let about_x = Joint::Revolute {
        axis: Vector3::x_axis(),
    };
    let output = tree.attach(LinkId::GROUND, Pose::translation(x, y, z), about_x)?;
    let end_of_rod = Attachment {
        link: rod,
        pose: Pose::translation(ROD, 0.0, 0.0),
    };
    let output_pin = Attachment {
        link: output,
        pose: Pose::translation(0.0, OUTPUT, 0.0),
    };
    let ball = Closure::new(&tree, end_of_rod, output_pin, &Joint::Spherical);
    let (th, ph) = (tree.coordinate_range(input).start, tree.coordinate_range(output).start);
    let mut input_held = vec![false; tree.speeds()];
    input_held[tree.speed_range(input).start] = true;
    // The rod may spin about itself, so that branches have no sign here. The first position is found with the output held at
    // its closed form; from there on every position is the guess of the next.
    let mut both_held = input_held.clone();
    both_held[tree.speed_range(output).start] = true;

    println!("input [deg]  output [deg], branch +    branch -");
    let mut worst: f64 = 0.0;
    let mut table = vec![[0.0; 2]; 361];
    for (branch, sign) in [1.0, -1.0].into_iter().enumerate() {
        let mut q = tree.neutral();
        q[ph] = closed_form(0.0, sign);
        let settings = Settings::default();
        q = assembly::assemble(&tree, std::slice::from_ref(&ball), &q, &both_held, &settings)?.q;
        for (degrees, row) in table.iter_mut().enumerate() {
            q[th] = (degrees as f64).to_radians();
            q = assembly::assemble(&tree, std::slice::from_ref(&ball), &q, &input_held, &settings)?.q;
            worst = worst.max(within_half_turn(q[ph] - closed_form(q[th], sign)).abs());
            row[branch] = q[ph].to_degrees();
        }
    }
    for (degrees, [plus, minus]) in table.iter().enumerate().step_by(30) {
        println!("{degrees:11}  {plus:22.12}  {minus:18.12}");
    }
    println!("largest difference to the closed form: {worst:.1e} rad");
    assert!(worst < 1e-12);

    // Out of reach: the input is held, the rod cannot span the gap, and the error says so.
    let far = Attachment {
        link: rod,
        pose: Pose::translation(0.1, 0.0, 0.0),
    };
    let short = Closure::new(&tree, far, output_pin, &Joint::Spherical);
    let refused = assembly::assemble(&tree, &[short], &tree.neutral(), &input_held, &Settings::default());
    match refused {
        Err(error @ AssemblyError::NotClosed { .. }) => println!("with a rod of 0.1 m: {error}"),
        other => return Err(format!("a rod too short was accepted: {other:?}").into()),
    }
    Ok(())
}

/// The same direction as an angle from -pi to pi.
fn within_half_turn(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

/// Output angle for an input angle; the sign tells the branch.
fn closed_form(th: f64, sign: f64) -> f64 {
    let [x, y, z] = SECOND_BASE;
    let w = Vector3::new(x - INPUT * th.cos(), y - INPUT * th.sin(), z);
    let (p, q) = (2.0 * OUTPUT * w.z, 2.0 * OUTPUT * w.y);
    let r = w.norm_squared() + OUTPUT * OUTPUT - ROD * ROD;
    within_half_turn(2.0 * (-p + sign * (p * p + q * q - r * r).sqrt()).atan2(r - q))
}
