//! Executes Structured Text: function blocks and programs of real, integer and Boolean variables.
//!
//! Parsed by `iecst`; every name is resolved once, so that a million calls take seconds. Written for tests of exported
//! text: unsupported language (loops, arrays, strings, pointers) is refused when a unit is loaded.

use iecst::{BinaryOp, CaseValue, Expr, ExprKind, Pou, PouKind, Stmt, StmtKind, TypeKind, UnaryOp};
use std::collections::BTreeMap;

/// Units that know each other by name.
#[derive(Default)]
pub struct Library {
    blocks: BTreeMap<String, Block>,
}

/// A unit, ready to run.
#[derive(Clone)]
struct Block {
    names: Vec<String>,
    start: Vec<f64>,
    /// Slot and unit of each instance.
    instances: Vec<(String, String)>,
    body: Vec<Code>,
    /// REAL: every operation rounds to single precision.
    single: bool,
}

/// A unit with its variables.
pub struct Instance {
    block: Block,
    values: Vec<f64>,
    inner: Vec<Instance>,
}

#[derive(Clone)]
enum Node {
    Number(f64),
    Variable(usize),
    /// A variable of an instance.
    Member(usize, usize),
    Negative(Box<Node>),
    Not(Box<Node>),
    Binary(BinaryOp, Box<Node>, Box<Node>),
    Call(Function, Vec<Node>),
}

#[derive(Clone, Copy)]
enum Function {
    Abs,
    Exp,
    Ln,
    Sin,
    Sqrt,
    Cos,
    Expt,
    Min,
    Max,
    ToDint,
    OfDint,
}

#[derive(Clone)]
enum Code {
    Set(usize, Node),
    If(Vec<(Node, Vec<Code>)>, Vec<Code>),
    Case(Node, BTreeMap<i64, Vec<Code>>, Vec<Code>),
    Run(usize, Vec<(usize, Node)>),
}

impl Library {
    /// Parses a unit, checks its types, and adds it. A unit that uses others comes after them.
    ///
    /// # Errors
    /// With what the parser or its type check found, or what is not known here.
    pub fn add(&mut self, text: &str) -> Result<(), String> {
        let parse = |text: &str| iecst::parse_pou(text).map_err(|e| format!("{e:?}"));
        let pou = parse(text)?;
        // A literal takes the type of what it meets; iecst calls every one LREAL. A unit has one of the two types.
        let long = text.replace(": REAL", ": LREAL");
        let errors: Vec<String> = iecst::analyze_pou(&parse(&long)?)
            .into_iter()
            .filter(|d| d.severity == iecst::Severity::Error)
            .map(|d| d.format_with_source(&long))
            .collect();
        if !errors.is_empty() {
            return Err(errors.join("\n"));
        }
        let block = Loader::new(self, &pou)?.block(&pou)?;
        self.blocks.insert(pou.name.to_uppercase(), block);
        Ok(())
    }

    /// An instance of a unit, all variables at their initial values.
    ///
    /// # Panics
    /// When there is no such unit.
    pub fn instance(&self, name: &str) -> Instance {
        let block = self.blocks[&name.to_uppercase()].clone();
        Instance {
            values: block.start.clone(),
            inner: block
                .instances
                .iter()
                .map(|(_, unit)| self.instance(unit))
                .collect(),
            block,
        }
    }
}

impl Instance {
    /// The slot of a variable.
    ///
    /// # Panics
    /// When there is no such variable.
    pub fn slot(&self, name: &str) -> usize {
        let name = name.to_uppercase();
        let found = self.block.names.iter().position(|n| *n == name);
        found.unwrap_or_else(|| panic!("no variable {name}"))
    }

    /// The value in a slot; TRUE is 1.
    pub fn get(&self, slot: usize) -> f64 {
        self.values[slot]
    }

    /// Gives a slot a value.
    pub fn set(&mut self, slot: usize, value: f64) {
        self.values[slot] = self.round(value);
    }

    /// One call.
    ///
    /// # Panics
    /// On an overflow or a result that is not a number: controllers stop there.
    pub fn call(&mut self) {
        let body = std::mem::take(&mut self.block.body);
        self.run(&body);
        self.block.body = body;
    }

    fn run(&mut self, body: &[Code]) {
        for code in body {
            match code {
                Code::Set(slot, value) => self.values[*slot] = self.eval(value),
                Code::If(branches, otherwise) => {
                    let taken = branches.iter().find(|(when, _)| self.eval(when) != 0.0);
                    self.run(taken.map_or(otherwise, |(_, body)| body));
                }
                Code::Case(on, branches, otherwise) => {
                    let taken = branches.get(&(self.eval(on) as i64));
                    self.run(taken.unwrap_or(otherwise));
                }
                Code::Run(instance, inputs) => {
                    for (slot, value) in inputs {
                        let value = self.eval(value);
                        self.inner[*instance].set(*slot, value);
                    }
                    self.inner[*instance].call();
                }
            }
        }
    }

    fn round(&self, x: f64) -> f64 {
        // A result in double precision rounded once more is the result in single precision.
        if self.block.single {
            f64::from(x as f32)
        } else {
            x
        }
    }

    fn eval(&self, node: &Node) -> f64 {
        let of = |b: bool| f64::from(u8::from(b));
        match node {
            Node::Number(x) => *x,
            Node::Variable(slot) => self.values[*slot],
            Node::Member(instance, slot) => self.inner[*instance].values[*slot],
            Node::Negative(x) => -self.eval(x),
            Node::Not(x) => of(self.eval(x) == 0.0),
            Node::Binary(op, a, b) => {
                // Both sides: IEC 61131-3 does not promise to leave one out.
                let (a, b) = (self.eval(a), self.eval(b));
                match op {
                    BinaryOp::Add => self.arithmetic(a + b),
                    BinaryOp::Sub => self.arithmetic(a - b),
                    BinaryOp::Mul => self.arithmetic(a * b),
                    BinaryOp::Div => self.arithmetic(a / b),
                    BinaryOp::Eq => of(a == b),
                    BinaryOp::Ne => of(a != b),
                    BinaryOp::Lt => of(a < b),
                    BinaryOp::Le => of(a <= b),
                    BinaryOp::Gt => of(a > b),
                    BinaryOp::Ge => of(a >= b),
                    BinaryOp::And => of(a != 0.0 && b != 0.0),
                    BinaryOp::Or => of(a != 0.0 || b != 0.0),
                    BinaryOp::Xor => of((a != 0.0) != (b != 0.0)),
                    BinaryOp::Mod | BinaryOp::Power => unreachable!("refused when loaded"),
                }
            }
            Node::Call(function, arguments) => {
                let x = self.eval(&arguments[0]);
                match function {
                    Function::Abs => x.abs(),
                    Function::Exp => self.arithmetic(x.exp()),
                    Function::Ln => self.arithmetic(x.ln()),
                    Function::Sin => self.arithmetic(x.sin()),
                    Function::Sqrt => self.arithmetic(x.sqrt()),
                    Function::Cos => self.arithmetic(x.cos()),
                    Function::Expt => self.arithmetic(x.powf(self.eval(&arguments[1]))),
                    // A conversion rounds to the nearest, and to the even one of two.
                    Function::ToDint if x.abs() < 2147483648.0 => x.round_ties_even(),
                    Function::ToDint => panic!("{x} as a DINT"),
                    Function::OfDint => self.arithmetic(x),
                    Function::Min => x.min(self.eval(&arguments[1])),
                    Function::Max => x.max(self.eval(&arguments[1])),
                }
            }
        }
    }

    fn arithmetic(&self, x: f64) -> f64 {
        let x = self.round(x);
        assert!(x.is_finite(), "overflow or NaN: a controller may stop here");
        x
    }
}

/// Resolves the names of one unit.
struct Loader<'l> {
    library: &'l Library,
    names: Vec<String>,
    start: Vec<f64>,
    instances: Vec<(String, String)>,
    single: bool,
}

impl<'l> Loader<'l> {
    fn new(library: &'l Library, pou: &Pou) -> Result<Self, String> {
        if pou.kind == PouKind::Function {
            return Err("functions are not supported".into());
        }
        let mut loader = Loader {
            library,
            names: Vec::new(),
            start: Vec::new(),
            instances: Vec::new(),
            single: false,
        };
        let mut double = false;
        for var in pou.var_blocks.iter().flat_map(|block| &block.vars) {
            let TypeKind::Simple(kind) = &var.var_type.kind else {
                return Err(format!("type of {}", var.name));
            };
            let name = var.name.to_uppercase();
            match kind.to_uppercase().as_str() {
                "REAL" => loader.single = true,
                "LREAL" => double = true,
                "BOOL" | "DINT" => {}
                other if library.blocks.contains_key(other) => {
                    loader.instances.push((name, other.to_string()));
                    continue;
                }
                other => return Err(format!("type {other} of {}", var.name)),
            }
            loader.names.push(name);
            loader.start.push(0.0);
        }
        if double && loader.single {
            return Err("both REAL and LREAL".into());
        }
        Ok(loader)
    }

    fn block(mut self, pou: &Pou) -> Result<Block, String> {
        for var in pou.var_blocks.iter().flat_map(|block| &block.vars) {
            if let Some(initial) = &var.initial {
                let value = match self.node(initial)? {
                    Node::Number(x) => x,
                    Node::Negative(x) => match *x {
                        Node::Number(x) => -x,
                        _ => return Err(format!("initial value of {}", var.name)),
                    },
                    _ => return Err(format!("initial value of {}", var.name)),
                };
                let slot = self.slot(&var.name)?;
                self.start[slot] = if self.single {
                    f64::from(value as f32)
                } else {
                    value
                };
            }
        }
        let body = self.body(&pou.body)?;
        Ok(Block {
            names: self.names,
            start: self.start,
            instances: self.instances,
            body,
            single: self.single,
        })
    }

    fn slot(&self, name: &str) -> Result<usize, String> {
        let name = name.to_uppercase();
        let found = self.names.iter().position(|n| *n == name);
        found.ok_or_else(|| format!("no variable {name}"))
    }

    /// An instance, and a variable of its unit.
    fn member(&self, instance: &str, name: &str) -> Result<(usize, usize), String> {
        let (instance, name) = (instance.to_uppercase(), name.to_uppercase());
        let at = self.instances.iter().position(|(n, _)| *n == instance);
        let at = at.ok_or_else(|| format!("no instance {instance}"))?;
        let block = &self.library.blocks[&self.instances[at].1];
        let slot = block.names.iter().position(|n| *n == name);
        Ok((
            at,
            slot.ok_or_else(|| format!("no variable {instance}.{name}"))?,
        ))
    }

    fn body(&self, statements: &[Stmt]) -> Result<Vec<Code>, String> {
        let mut out = Vec::new();
        for statement in statements {
            out.push(match &statement.kind {
                StmtKind::Empty => continue,
                StmtKind::Assignment { target, value } => match &target.kind {
                    ExprKind::Ident(name) => Code::Set(self.slot(name)?, self.node(value)?),
                    other => return Err(format!("assignment to {other:?}")),
                },
                StmtKind::If {
                    condition,
                    then_body,
                    elsif_branches,
                    else_body,
                } => {
                    let mut branches = vec![(self.node(condition)?, self.body(then_body)?)];
                    for (when, body) in elsif_branches {
                        branches.push((self.node(when)?, self.body(body)?));
                    }
                    Code::If(branches, self.body(else_body.as_deref().unwrap_or(&[]))?)
                }
                StmtKind::Case {
                    expr,
                    cases,
                    else_body,
                } => {
                    let mut branches = BTreeMap::new();
                    for case in cases {
                        for value in &case.values {
                            let CaseValue::Single(Expr {
                                kind: ExprKind::IntLiteral(k),
                                ..
                            }) = value
                            else {
                                return Err(format!("case {value:?}"));
                            };
                            branches.insert(*k, self.body(&case.body)?);
                        }
                    }
                    let otherwise = self.body(else_body.as_deref().unwrap_or(&[]))?;
                    Code::Case(self.node(expr)?, branches, otherwise)
                }
                StmtKind::Call { name, args } => {
                    let mut inputs = Vec::new();
                    let mut at = None;
                    for arg in args {
                        let (Some(input), Some(value)) = (&arg.name, &arg.value) else {
                            return Err(format!("call of {name}: inputs by name only"));
                        };
                        let (instance, slot) = self.member(name, input)?;
                        at = Some(instance);
                        inputs.push((slot, self.node(value)?));
                    }
                    Code::Run(at.ok_or("a call without inputs")?, inputs)
                }
                other => return Err(format!("statement {other:?}")),
            });
        }
        Ok(out)
    }

    fn node(&self, expr: &Expr) -> Result<Node, String> {
        let boxed = |e: &Expr| self.node(e).map(Box::new);
        // A literal takes the type of what it meets.
        let literal = |x: f64| if self.single { f64::from(x as f32) } else { x };
        Ok(match &expr.kind {
            ExprKind::IntLiteral(k) => Node::Number(*k as f64),
            ExprKind::RealLiteral(x) => Node::Number(literal(*x)),
            ExprKind::BoolLiteral(b) => Node::Number(f64::from(u8::from(*b))),
            ExprKind::Ident(name) => Node::Variable(self.slot(name)?),
            ExprKind::Paren(inner) => self.node(inner)?,
            ExprKind::UnaryOp {
                op: UnaryOp::Neg,
                expr,
            } => Node::Negative(boxed(expr)?),
            ExprKind::UnaryOp {
                op: UnaryOp::Not,
                expr,
            } => Node::Not(boxed(expr)?),
            ExprKind::BinaryOp {
                op: BinaryOp::Mod | BinaryOp::Power,
                ..
            } => {
                return Err("MOD and ** are not supported".into());
            }
            ExprKind::BinaryOp { left, op, right } => {
                Node::Binary(*op, boxed(left)?, boxed(right)?)
            }
            ExprKind::MemberAccess { expr, member } => match &expr.kind {
                ExprKind::Ident(instance) => {
                    let (instance, slot) = self.member(instance, member)?;
                    Node::Member(instance, slot)
                }
                other => return Err(format!("member of {other:?}")),
            },
            ExprKind::FunctionCall { name, args } => {
                let (function, count) = match name.to_uppercase().as_str() {
                    "ABS" => (Function::Abs, 1),
                    "EXP" => (Function::Exp, 1),
                    "LN" => (Function::Ln, 1),
                    "SIN" => (Function::Sin, 1),
                    "SQRT" => (Function::Sqrt, 1),
                    "COS" => (Function::Cos, 1),
                    "EXPT" => (Function::Expt, 2),
                    "LREAL_TO_DINT" | "REAL_TO_DINT" => (Function::ToDint, 1),
                    "DINT_TO_LREAL" | "DINT_TO_REAL" => (Function::OfDint, 1),
                    "MIN" => (Function::Min, 2),
                    "MAX" => (Function::Max, 2),
                    other => return Err(format!("function {other}")),
                };
                let values: Vec<&Expr> = args.iter().filter_map(|a| a.value.as_ref()).collect();
                if values.len() != count {
                    return Err(format!("{name} takes {count}"));
                }
                let nodes: Result<Vec<Node>, String> =
                    values.into_iter().map(|e| self.node(e)).collect();
                Node::Call(function, nodes?)
            }
            other => return Err(format!("expression {other:?}")),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Library;

    #[test]
    fn a_program_runs() {
        let mut library = Library::default();
        library
            .add("FUNCTION_BLOCK Twice VAR_INPUT x : LREAL; END_VAR VAR_OUTPUT y : LREAL := -1.5; END_VAR y := x * 2.0 - 3.0 + y; END_FUNCTION_BLOCK")
            .unwrap();
        library
            .add("PROGRAM P VAR b : Twice; k : DINT := 0; s : LREAL; END_VAR CASE k OF 0: s := 1.0; 1: s := -EXP(0.0); ELSE s := 7.0; END_CASE; b(x := s); IF b.y > 0.0 OR NOT (k < 2) THEN s := b.y; END_IF; k := k + 1; END_PROGRAM")
            .unwrap();
        let mut p = library.instance("P");
        let s = p.slot("s");
        let seen: Vec<f64> = (0..3)
            .map(|_| {
                p.call();
                p.get(s)
            })
            .collect();
        assert_eq!(seen, [1.0, -1.0, 3.5]);
    }

    #[test]
    fn faults_are_found() {
        let refused = |body: &str| {
            let text = format!("PROGRAM P VAR x : LREAL; b : BOOL; END_VAR {body} END_PROGRAM");
            Library::default().add(&text).is_err()
        };
        assert!(!refused("x := 1.0;"));
        for body in [
            "y := 1.0;",
            "x := ;",
            "x := TAN(1.0);",
            "WHILE b DO x := 1.0; END_WHILE",
            "x := z.a;",
        ] {
            assert!(refused(body), "{body}");
        }
    }
}
