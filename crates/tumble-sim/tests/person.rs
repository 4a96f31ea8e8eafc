//! The person: driven by scripted lines, and together with a toy board that asks for faces and turns.

use std::collections::BTreeSet;
use tumble_sim::motion::{Hands, Kind};
use tumble_sim::person::{Clumsiness, NoteKind};
use tumble_sim::{Direction, Face, Person, PersonConfig, World, WorldConfig};

const STEP_S: f64 = 0.01;

struct Scene {
    world: World,
    person: Person,
    now_s: f64,
    typed: String,
}

impl Scene {
    fn new(config: PersonConfig) -> Self {
        let mut world = WorldConfig::nominal(config.seed);
        if config.start_words.as_deref().is_some_and(|words| words.contains("by-hand")) {
            world.motion.hands = Hands::by_hand();
        }
        let (world, person) = (World::new(&world).unwrap(), Person::new(config).unwrap());
        Self { world, person, now_s: 0.0, typed: String::new() }
    }

    fn step(&mut self) {
        let typed = self.person.act(self.now_s, &mut self.world);
        self.typed.push_str(&String::from_utf8(typed).unwrap());
        self.now_s += STEP_S;
    }

    /// Repeats a line every second for so long.
    fn repeat(&mut self, line: &str, seconds: f64) {
        for k in 0..(seconds / STEP_S) as usize {
            if k % 100 == 0 {
                self.say(line);
            }
            self.step();
        }
    }

    fn say(&mut self, line: &str) {
        self.person.hear(self.now_s, format!("A sentence for a person.\r\n{line}\r\n").as_bytes());
    }

    fn kinds(&self) -> Vec<Kind> {
        self.world.motion.segments().iter().map(|segment| segment.kind()).collect()
    }
}

#[test]
fn it_types_its_words_once_after_the_hello() {
    let mut scene = Scene::new(PersonConfig::fenced(1));
    scene.say("@hello firmware=0.1.0 board=x calibration=none");
    scene.step();
    assert_eq!(scene.typed, "", "not before its reaction time");
    scene.repeat("@ok command=calibrate", 2.0);
    assert_eq!(scene.typed, "calibrate fenced square\r\n");
    scene.say("@hello firmware=0.1.0 board=x calibration=stored");
    scene.repeat("@ok command=nothing", 8.0);
    assert_eq!(scene.typed, "calibrate fenced square\r\n");
    scene.person.instruct(scene.now_s, "verify");
    scene.repeat("", 12.0);
    assert_eq!(scene.typed.matches("verify\r\n").count(), 3, "three tries without an answer");
}

#[test]
fn it_types_even_if_it_missed_the_hello() {
    let mut scene = Scene::new(PersonConfig::by_hand(1));
    scene.repeat("", 6.0);
    assert!(scene.typed.starts_with("calibrate by-hand square\r\n"));
}

#[test]
fn it_does_what_is_asked_once_and_again_when_patience_ends() {
    let mut scene = Scene::new(PersonConfig::fenced(2));
    scene.repeat("@ask want=place faces=+x,-y", 7.0);
    assert_eq!(scene.kinds(), [Kind::Carry]);
    let up = scene.world.motion.standing().up.unwrap();
    assert!([Face::PlusX, Face::MinusY].contains(&up));
    scene.repeat("@ask want=hold face=+x seconds=2", 10.0);
    assert_eq!(scene.kinds().len(), 1, "hands off during a hold");
    scene.say("@accepted what=still face=+x held_s=3.1");
    scene.repeat("@ask want=turn face=+x direction=cw", 16.0);
    assert_eq!(scene.kinds(), [Kind::Carry, Kind::Turn]);
    assert!(scene.world.motion.segments()[1].turned_rad() < -6.2);
    scene.repeat("@ask want=turn face=+x direction=cw", 12.0);
    assert_eq!(scene.kinds().len(), 3, "not accepted: once more");
    scene.repeat("", 20.0);
    assert_eq!(scene.kinds().len(), 3, "a request that is no longer repeated is over");
}

#[test]
fn a_refused_turn_is_done_again_at_once() {
    let mut scene = Scene::new(PersonConfig::fenced(3));
    scene.repeat("@ask want=turn face=+z direction=either", 14.0);
    scene.say("@refused what=turn face=+z angle_deg=271.3 why=incomplete");
    scene.repeat("@ask want=turn face=+z direction=either", 2.0);
    assert_eq!(scene.kinds(), [Kind::Turn, Kind::Turn]);
}

#[test]
fn a_steady_led_holds_the_hands_back() {
    let mut scene = Scene::new(PersonConfig::fenced(4));
    scene.person.see_led(scene.now_s, true);
    scene.repeat("", 1.5);
    scene.repeat("@ask want=turn face=+z direction=ccw", 2.5);
    assert!(scene.kinds().is_empty());
    scene.person.see_led(scene.now_s, false);
    scene.repeat("@ask want=turn face=+z direction=ccw", 1.5);
    assert_eq!(scene.kinds(), [Kind::Turn]);
    assert!(scene.person.take_notes().iter().any(|note| note.kind == NoteKind::Saw));
}

#[test]
fn poses_differ_and_still_brings_it_back_to_a_face() {
    let mut scene = Scene::new(PersonConfig::fenced(5));
    scene.repeat("@ask want=pose done=0 of=6", 6.0);
    let first = scene.world.true_attitude(scene.now_s);
    scene.repeat("@ask want=pose done=1 of=6", 6.0);
    assert!(first.angle_to(&scene.world.true_attitude(scene.now_s)) > 0.1);
    assert_eq!(scene.world.motion.standing().up, None);
    scene.repeat("@ask want=still", 6.0);
    assert!(scene.world.motion.standing().up.is_some());
}

/// A board that knows the truth: enough to close the loop around the person.
#[derive(Default)]
struct ToyBoard {
    stills: BTreeSet<Face>,
    turns: BTreeSet<(Face, bool)>,
    seen: usize,
    idle_s: f64,
    refused: u32,
}

impl ToyBoard {
    fn is_done(&self) -> bool {
        self.stills.len() == 6 && self.turns.len() == 12
    }

    fn observe(&mut self, world: &World, now_s: f64) -> Option<String> {
        self.idle_s = if world.motion_idle_at(now_s) { self.idle_s + STEP_S } else { 0.0 };
        let up = world.motion.standing().up?;
        if self.idle_s < 1.0 {
            return None;
        }
        let segments = world.motion.segments();
        let turn = segments.get(self.seen..)?.iter().find(|s| s.kind() == Kind::Turn).map(|s| s.turned_rad());
        self.seen = segments.len();
        if let Some(angle) = turn {
            let full = (angle.abs().to_degrees() - 360.0).abs() < 20.0;
            self.refused += u32::from(!full);
            if full {
                self.turns.insert((up, angle > 0.0));
            }
            let word = if full { "@accepted what=turn" } else { "@refused what=turn" };
            return Some(format!("{word} face={up}"));
        }
        (self.idle_s > 3.0 && self.stills.insert(up)).then(|| format!("@accepted what=still face={up}"))
    }

    fn request(&self, up: Option<Face>) -> String {
        let missing = |face: Face| {
            !self.stills.contains(&face) || [true, false].iter().any(|way| !self.turns.contains(&(face, *way)))
        };
        match up.filter(|face| missing(*face)) {
            None => {
                let faces: Vec<&str> = Face::ALL.into_iter().filter(|f| missing(*f)).map(Face::name).collect();
                format!("@ask want=place faces={}", faces.join(","))
            }
            Some(face) if !self.stills.contains(&face) => format!("@ask want=hold face={face} seconds=1"),
            Some(face) => {
                let ccw = !self.turns.contains(&(face, true));
                let direction = if ccw { Direction::Ccw } else { Direction::Cw };
                format!("@ask want=turn face={face} direction={}", direction.name())
            }
        }
    }
}

/// Runs a whole session; returns the board, the scene and how long it took.
fn session(config: PersonConfig) -> (ToyBoard, Scene) {
    let (mut board, mut scene) = (ToyBoard::default(), Scene::new(config));
    let mut tick = 0u32;
    while !board.is_done() && scene.now_s < 2000.0 {
        if let Some(line) = board.observe(&scene.world, scene.now_s) {
            scene.say(&line);
            tick = 0;
        }
        if tick.is_multiple_of(100) {
            let up = scene.world.motion.standing().up.filter(|_| scene.world.motion_idle_at(scene.now_s));
            scene.say(&board.request(up));
        }
        tick += 1;
        scene.step();
    }
    (board, scene)
}

#[test]
fn a_whole_session_ends_in_time() {
    let (board, scene) = session(PersonConfig::fenced(7));
    assert!(board.is_done() && board.refused == 0);
    assert!(scene.now_s < 260.0, "took {} s", scene.now_s);
    let turns = scene.kinds().iter().filter(|kind| **kind == Kind::Turn).count();
    assert_eq!(turns, 12);
    let (again, other) = (session(PersonConfig::fenced(7)).1, session(PersonConfig::fenced(8)).1);
    assert_eq!(scene.world.motion.segments(), again.world.motion.segments(), "the same seed does the same");
    assert_ne!(scene.world.motion.segments(), other.world.motion.segments());
}

#[test]
fn a_clumsy_session_still_ends() {
    let clumsiness =
        Clumsiness { bump: 0.3, wrong_direction: 0.3, short_turn: 0.3, wrong_face: 0.3, at_most: Some(12) };
    let (board, mut scene) = session(PersonConfig { clumsiness, ..PersonConfig::by_hand(9) });
    assert!(board.is_done(), "after {} s", scene.now_s);
    assert!(scene.person.mishaps() >= 5 && board.refused > 0);
    let notes = scene.person.take_notes();
    assert!(notes.iter().any(|note| note.text.contains("bumps")));
    assert!(notes.iter().any(|note| note.text.contains("not quite")));
    assert!(notes.windows(2).all(|pair| pair[0].t_s <= pair[1].t_s), "in order of time");
}

#[test]
fn garbage_on_the_console_is_borne() {
    let mut scene = Scene::new(PersonConfig::fenced(1));
    let garbage: Vec<u8> = (0..20_000u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    scene.person.hear(0.0, &garbage);
    scene.repeat("@ask want=place faces=,,q", 3.0);
    scene.repeat("@ask want=turn", 3.0);
    assert_eq!(scene.kinds(), [Kind::Turn], "a turn without a face is a turn");
    let bad = PersonConfig { reaction_s: (f64::NAN, 1.0), ..PersonConfig::fenced(1) };
    assert!(Person::new(bad).unwrap_err().to_string().contains("reaction_s"));
}
