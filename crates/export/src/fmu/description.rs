//! `modelDescription.xml` in both versions, and how a tool builds the source.

use super::unit::Unit;
use super::variables::{Role, Start, Variable, Variables};
use super::version::{Version, escape};
use crate::Model;
use crate::header::plain;
use crate::number::Literal;
use std::fmt::Write;

pub(super) fn xml(
    model: &Model,
    version: Version,
    component: &str,
    token: &str,
    variables: &Variables,
) -> String {
    let (three, step) = (version == Version::Three, model.settings.cycle_time.c());
    let about = format!(
        "Friction compensator of the axis '{}', law {}; model sha256 {}",
        model.title,
        model.law(),
        model.provenance.model_sha256
    );
    let about = escape(&plain(&about));
    let tool = escape(&plain(&model.provenance.version));
    let mut out = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = if three {
        write!(
            out,
            "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{component}\" instantiationToken=\"{token}\" description=\"{about}\" \
             generationTool=\"stiction {tool}\" variableNamingConvention=\"flat\">\n\
             \x20 <CoSimulation modelIdentifier=\"{component}\" canHandleVariableCommunicationStepSize=\"true\" \
             canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" fixedInternalStepSize=\"{step}\"/>\n"
        )
    } else {
        write!(
            out,
            "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{component}\" guid=\"{token}\" description=\"{about}\" \
             generationTool=\"stiction {tool}\" variableNamingConvention=\"flat\" numberOfEventIndicators=\"0\">\n\
             \x20 <CoSimulation modelIdentifier=\"{component}\" canHandleVariableCommunicationStepSize=\"true\" \
             canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\">\n\
             \x20   <SourceFiles>\n      <File name=\"{component}.c\"/>\n    </SourceFiles>\n  </CoSimulation>\n"
        )
    };
    units(model, &mut out);
    out.push_str(
        "  <LogCategories>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n",
    );
    let _ = writeln!(
        out,
        "  <DefaultExperiment startTime=\"0.0\" stopTime=\"{}\" stepSize=\"{step}\"/>\n  <ModelVariables>",
        (1000.0 * model.settings.cycle_time).c()
    );
    if three {
        out.push_str("    <Float64 name=\"time\" valueReference=\"0\" causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n");
    }
    for (reference, variable) in variables.iter() {
        entry(model, version, reference, variable, &mut out);
    }
    out.push_str("  </ModelVariables>\n  <ModelStructure>\n");
    structure(version, variables, &mut out);
    out.push_str("  </ModelStructure>\n</fmiModelDescription>\n");
    out
}

fn units(model: &Model, out: &mut String) {
    out.push_str("  <UnitDefinitions>\n");
    for unit in Unit::ALL {
        let exponents: String = ["kg", "m", "s", "A", "rad", "K"]
            .into_iter()
            .zip(unit.base(model.rotary, model.force_unit()))
            .filter(|(_, exponent)| *exponent != 0)
            .map(|(base, exponent)| format!(" {base}=\"{exponent}\""))
            .collect();
        let _ = writeln!(
            out,
            "    <Unit name=\"{}\">\n      <BaseUnit{exponents}/>\n    </Unit>",
            unit.name(model.rotary, model.force_unit())
        );
    }
    out.push_str("  </UnitDefinitions>\n");
}

fn entry(model: &Model, version: Version, reference: usize, variable: &Variable, out: &mut String) {
    let (causality, variability) = match (variable.role, &variable.start) {
        (Role::Input, Start::Number(..)) => ("input", "continuous"),
        (Role::Input, Start::Flag(_)) => ("input", "discrete"),
        (Role::Output, _) => ("output", "discrete"),
        (Role::Local, _) => ("local", "discrete"),
        (Role::Tunable, _) => ("parameter", "tunable"),
        (Role::Fixed, _) => ("parameter", "fixed"),
    };
    let initial = match variable.role {
        Role::Input => "",
        _ => " initial=\"exact\"",
    };
    let unit = match variable.start {
        Start::Number(_, unit) if unit != Unit::One => {
            format!(" unit=\"{}\"", unit.name(model.rotary, model.force_unit()))
        }
        _ => String::new(),
    };
    let (name, about, start) = (&variable.name, &variable.about, variable.start.text());
    let head = format!(
        "name=\"{name}\" valueReference=\"{reference}\" causality=\"{causality}\" variability=\"{variability}\"{initial} \
         description=\"{}\"",
        escape(about)
    );
    let number = matches!(variable.start, Start::Number(..));
    let _ = match (version, number) {
        (Version::Two, _) => writeln!(
            out,
            "    <ScalarVariable {head}>\n      <{}{unit} start=\"{start}\"/>\n    </ScalarVariable>",
            if number { "Real" } else { "Boolean" }
        ),
        (Version::Three, true) => writeln!(out, "    <Float64 {head}{unit} start=\"{start}\"/>"),
        (Version::Three, false) => writeln!(out, "    <Boolean {head} start=\"{start}\"/>"),
    };
}

/// No output depends on an input of the same instant: the force is that of the sample before.
fn structure(version: Version, variables: &Variables, out: &mut String) {
    let outputs = variables.iter().filter(|(_, v)| v.role == Role::Output);
    match version {
        Version::Two => {
            out.push_str("    <Outputs>\n");
            for (reference, _) in outputs {
                // An index counts from 1, and the references do too.
                let _ = writeln!(
                    out,
                    "      <Unknown index=\"{reference}\" dependencies=\"\"/>"
                );
            }
            out.push_str("    </Outputs>\n");
        }
        Version::Three => {
            for (reference, _) in outputs {
                let _ = writeln!(
                    out,
                    "    <Output valueReference=\"{reference}\" dependencies=\"\"/>"
                );
            }
        }
    }
}

/// How a tool builds an FMU of version 3 from its source.
pub(super) fn build(component: &str) -> String {
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <fmiBuildDescription fmiVersion=\"3.0\">\n\
         \x20 <BuildConfiguration modelIdentifier=\"{component}\">\n\
         \x20   <SourceFileSet language=\"C99\">\n\
         \x20     <SourceFile name=\"{component}.c\"/>\n\
         \x20   </SourceFileSet>\n\
         \x20   <Library name=\"m\"/>\n\
         \x20 </BuildConfiguration>\n\
         </fmiBuildDescription>\n"
    )
}
