"""``lidarena export NAME --onnx FILE``: a trained agent for a robot, without Python."""

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from lidarena.agents.learned_policy import LearnedPolicy

_TRIALS = 100


def add_to(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Add the subcommand to a program's."""
    text = "Write a trained agent as ONNX, and compare its actions with the agent's where onnxruntime is installed."
    parser = commands.add_parser("export", help="write a trained agent as ONNX", description=text)
    agent_help = "run folder, policy.json, or a shipped agent (lidarena list agents)"
    parser.add_argument("agent", metavar="NAME", help=agent_help)
    parser.add_argument("--onnx", metavar="FILE", required=True, help="the file to write")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Export, and check what was exported.

    Raises:
        LidarenaError: There is no such agent, ONNX cannot express it, or the file cannot be written.
    """
    from lidarena.agents.onnx_export import export_onnx  # here, since it takes seconds to load PyTorch
    from lidarena.agents.policy_file import read_policy
    from lidarena.agents.shipped import PREFIX
    from lidarena.base.files import check_writable

    name = options.agent
    shipped = not Path(name).exists() and not name.startswith(PREFIX) and len(Path(name).parts) == 1
    policy = read_policy(PREFIX + name if shipped and not Path(name).suffix else name)
    check_writable(options.onnx)
    file = export_onnx(policy, options.onnx)
    print(f"agent:    trained in {policy.env_id}, {policy.training.get('steps', 'unknown')} steps")
    print(f"checked:  {_check(file, policy)}")
    print(f"onnx:     {file}")
    return 0


def _check(file: Path, policy: "LearnedPolicy") -> str:
    """Compare actions on random observations; a sentence."""
    import torch

    from lidarena.agents.onnx_export import ActionNetwork, sample_inputs

    try:
        import onnxruntime
    except ImportError:
        return "not compared with the agent, since onnxruntime is not installed (lidarena[onnx])"
    session = onnxruntime.InferenceSession(str(file), providers=["CPUExecutionProvider"])
    model, rng, equal = ActionNetwork(policy).eval(), np.random.default_rng(1), 0
    for _ in range(_TRIALS):
        inputs = sample_inputs(model, rng)
        with torch.inference_mode():
            expected = model(*(torch.as_tensor(inputs[name]) for name in model.input_names))[0].numpy()
        equal += bool(np.allclose(session.run(None, inputs)[0], expected, atol=1e-5))
    return f"{equal} of {_TRIALS} random observations give the agent's own action"
