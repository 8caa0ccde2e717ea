use std::collections::BTreeMap;

use super::error_model::SAFETY;
use super::*;
use crate::plan::{Quality, Rung};

/// A front of two scenes, in which each quality halves the error and trebles the time of the one below.
fn invented() -> MeasuredFront {
    let mut front = MeasuredFront { provenance: "invented".into(), passes: BTreeMap::new(), scenes: Vec::new() };
    for (name, light_elevation_deg, scale) in [("noon", 60.0, 1.0), ("dusk", -3.0, 4.0)] {
        let (mut errors, mut milliseconds) = (BTreeMap::new(), BTreeMap::new());
        for (place, step) in steps().enumerate() {
            errors.insert(step.to_string(), scale * 0.04 / f64::from(1 << place));
            milliseconds.insert(step.to_string(), 10.0 * 3_f64.powi(place as i32));
            let tables = ("sky_view".to_owned(), 9.0 * 3_f64.powi(place as i32));
            front.passes.insert(step.to_string(), [tables, ("compose".to_owned(), 1.0)].into());
        }
        let traits = SceneTraits { light_elevation_deg, ..traits() };
        let [least_errors, best_estimates] = [errors.clone(), errors.clone()];
        front.scenes.push(MeasuredScene {
            name: name.into(),
            traits,
            errors,
            least_errors,
            best_estimates,
            milliseconds,
        });
    }
    front
}

fn steps() -> impl Iterator<Item = LadderStep> {
    Quality::ALL.into_iter().map(|quality| LadderStep { rung: Rung::of(quality), treatment: Treatment::Harmonics })
}

fn traits() -> SceneTraits {
    SceneTraits {
        kind: SceneKind::Clear,
        light_elevation_deg: 60.0,
        ringing: 0.01,
        optical_depth: 0.3,
        camera_altitude_m: 2.0,
        lowest_view_deg: 0.0,
    }
}

fn calibration(scale: f64, power: f64) -> Calibration {
    let mut calibration = Calibration::default();
    for (place, step) in steps().enumerate().take(2) {
        let tables = ("sky_view".to_owned(), scale * 9.0 * 3_f64.powf(power * place as f64));
        calibration.add(step, [tables, ("compose".to_owned(), 5.0)].into());
    }
    calibration
}

#[test]
fn a_smaller_error_asks_for_dearer_settings_and_twilight_for_more_than_noon() {
    let front = invented();
    let (noon, dusk) = (traits(), SceneTraits { light_elevation_deg: -3.0, ..traits() });
    let rung = |scene: &SceneTraits, target| within_error(&front, scene, target, None).unwrap().step.rung;
    assert!(rung(&noon, 0.1) < rung(&noon, 0.02) && rung(&noon, 0.02) < rung(&noon, 0.008));
    assert!(rung(&noon, 0.05) < rung(&dusk, 0.05));
    let clouds = SceneTraits { kind: SceneKind::Clouds, ..noon };
    assert_eq!(within_error(&front, &clouds, 0.1, None), Err(GoalError::NotMeasured { kind: SceneKind::Clouds }));
    let message = within_error(&front, &noon, 1e-4, None).unwrap_err().to_string();
    assert!(message.contains("0.01 %") && message.contains("ultra harmonics"), "{message}");
}

#[test]
fn a_budget_buys_the_most_accurate_that_fits_on_the_device() {
    let front = invented();
    // Twice as slow a device: tables of 18, 54, 162 and 486 ms, and 5 ms for the picture.
    let here = calibration(2.0, 1.0);
    let choice = |budget| within_time(&front, &traits(), budget, &here);
    let medium = choice(100.0).unwrap();
    assert_eq!(medium.step.rung, Rung::of(Quality::Medium));
    assert!((medium.milliseconds.unwrap() - 59.0).abs() < 1e-9);
    assert_eq!(choice(167.1).unwrap().step.rung, Rung::of(Quality::High));
    assert!(choice(20.0).unwrap_err().to_string().contains("23 ms"));
    // No scene with clouds was measured: the dearest that fits.
    let clouds = SceneTraits { kind: SceneKind::Clouds, ..traits() };
    assert_eq!(within_time(&front, &clouds, 100.0, &here).unwrap().step.rung, Rung::of(Quality::Medium));
    // A device with units to spare takes no longer for finer tables.
    let wide = calibration(2.0, 0.0);
    assert_eq!(within_time(&front, &traits(), 25.0, &wide).unwrap().step.rung, Rung::of(Quality::Ultra));
}

#[test]
fn on_scenes_that_were_left_out_targets_are_met() {
    let front = MeasuredFront::built_in();
    assert!(front.scenes.len() >= 20 && front.steps().len() >= 10, "{}", front.provenance);
    let all = |safety| {
        let targets = [0.005, 0.01, 0.02, 0.05, 0.1].into_iter();
        let tried = targets.map(|target| TargetTrial::with_safety(front, &front.scenes, target, safety));
        tried.fold((0, 0), |(chosen, met), trial| (chosen + trial.chosen, met + trial.met))
    };
    let (chosen, met) = all(SAFETY);
    assert!(chosen > 2 * front.scenes.len() && met as f64 >= 0.95 * chosen as f64, "{met} of {chosen}");
    // Without a margin they would not be.
    let (chosen, met) = all(-0.5);
    assert!((met as f64) < 0.9 * chosen as f64, "{met} of {chosen}");
}

#[test]
fn a_choice_within_the_truths_noise_of_its_target_meets_it_as_measured_and_neither_meets_nor_misses_it_for_sure() {
    let mut scene = invented().scenes.remove(0);
    let step = LadderStep { rung: Rung::of(Quality::Medium), treatment: Treatment::Harmonics };
    let name = step.to_string();
    scene.errors.insert(name.clone(), 0.022);
    scene.least_errors.insert(name.clone(), 0.017);
    let choice = Choice { step, error: None, milliseconds: None };
    // Whether it is met, met as measured and missed.
    for (best, expected) in [(0.0195, [0, 1, 0]), (0.0205, [0, 0, 0])] {
        scene.best_estimates.insert(name.clone(), best);
        let trial = TargetTrial::of_choices(std::slice::from_ref(&scene), 0.02, |_| Some(choice));
        assert_eq!([trial.met, trial.met_as_measured, trial.missed], expected);
    }
}

/// Errors of steps on an invented scene: the source function's halve from preset to preset, harmonics stay at a floor. The finest is
/// off as well.
fn invented_error(step: LadderStep) -> f64 {
    let place = Rung::ALL.iter().position(|rung| *rung == step.rung).unwrap() as f64;
    match step.treatment {
        Treatment::SourceFunction => 0.02 * 0.5_f64.powf(0.5 * place),
        _ => 0.06 + 0.01 * 0.5_f64.powf(0.5 * place),
    }
}

fn price(step: LadderStep) -> f64 {
    let place = Rung::ALL.iter().position(|rung| *rung == step.rung).unwrap() as f64;
    2_f64.powf(place) * if step.treatment == Treatment::SourceFunction { 4.0 } else { 1.0 }
}

#[test]
fn a_search_on_the_scene_finds_the_cheapest_that_meets_the_target_and_renders_no_more_than_it_needs() {
    for (target, expected, needs) in [
        (0.08, "low harmonics", Quality::Medium),
        (0.03, "low source-function", Quality::Medium),
        (0.012, "low+3/4 source-function", Quality::High),
    ] {
        let mut asked = Vec::new();
        let choice = search(target, Rung::of(Quality::Ultra), price, |step, finest| {
            asked.push(step);
            Ok::<_, ()>((invented_error(step).powi(2) - invented_error(finest).powi(2)).sqrt())
        })
        .unwrap();
        assert_eq!(choice.step.to_string(), expected);
        let (found, truth) = (choice.error.unwrap(), invented_error(choice.step));
        assert!(found <= target && (0.95..1.4).contains(&(found / truth)), "{found} for {truth}");
        let dearest = asked.iter().map(|step| step.rung).max().unwrap();
        assert!(dearest <= Rung::of(needs), "{expected} needs no {}", dearest.name());
    }
}

#[test]
fn a_search_that_cannot_succeed_says_how_close_one_comes_and_one_that_cannot_render_says_why() {
    let distance = |step, finest| Ok::<_, ()>((invented_error(step) - invented_error(finest)).abs());
    let Err(SearchError::Goal(GoalError::TooClose { closest, .. })) =
        search(4e-4, Rung::of(Quality::Ultra), price, distance)
    else {
        panic!("nothing is so close")
    };
    assert_eq!(closest.step.to_string(), "ultra source-function");
    // Neither what may not be tried is, nor what could not help.
    for (target, dearest) in [(4e-4, Quality::High), (1e-6, Quality::Ultra)] {
        let closest = match search(target, Rung::of(dearest), price, distance) {
            Err(SearchError::Goal(GoalError::TooClose { closest, .. })) => closest.step.to_string(),
            other => panic!("{other:?}"),
        };
        assert_eq!(closest, "high source-function");
    }
    let lost = search(0.01, Rung::of(Quality::Ultra), price, |_, _| Err::<f64, _>("lost"));
    assert_eq!(lost, Err(SearchError::Picture("lost")));
}
